#include "answers/comparison/bite_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "answers/refusals.h"

namespace ist::answers {
namespace {

std::string or_none(const std::string& text) { return text.empty() ? "none" : text; }

bool same_mesh(const RecordedBody& one, const RecordedBody& other) {
  return one.hash == other.hash && one.vertices == other.vertices;
}

void require_same(const BiteRecord& before, const BiteRecord& after) {
  const auto refuse = [&](bool wrong, const std::string& what, const std::string& first,
                          const std::string& second, const char* remedy) {
    refuse_if(wrong, after.name, "{} is {}, and of {} it is {}: {}", what, or_none(second),
              before.name, or_none(first), remedy);
  };
  const bool exchanged = !same_mesh(before.fixed, after.fixed) &&
                         same_mesh(before.fixed, after.moving) &&
                         same_mesh(before.moving, after.fixed);
  refuse_if(exchanged, after.name,
            "its fixed body is the moving one of {}: give both bites with the same body fixed",
            before.name);
  const auto mesh = [&](const RecordedBody& first, const RecordedBody& second, const char* role) {
    refuse(!same_mesh(first, second), fmt::format("the {} body", role),
           fmt::format("{} ({}, {} vertices)", first.name, or_none(first.hash), first.vertices),
           fmt::format("{} ({}, {} vertices)", second.name, or_none(second.hash), second.vertices),
           "compare bites of the same meshes");
  };
  mesh(before.fixed, after.fixed, "fixed");
  mesh(before.moving, after.moving, "moving");
  const char* again = "measure both bites alike";
  refuse(before.unit != after.unit, "the unit", before.unit, after.unit,
         "measure both with the same --unit");
  refuse(before.frame != after.frame, "the frame", before.frame, after.frame, again);
  const auto list = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double each : numbers) text += fmt::format("{}{:g}", text.empty() ? "" : ",", each);
    return text;
  };
  refuse(before.region != after.region, "the region", list(before.region), list(after.region),
         "measure both with the same --region");
  refuse(before.contact != after.contact, "the distance of contacts", list({before.contact}),
         list({after.contact}), again);
  refuse(before.foundation != after.foundation, "the depth of the foundation",
         list({before.foundation}), list({after.foundation}), again);
  refuse(
      !before.numbering.empty() && !after.numbering.empty() && before.numbering != after.numbering,
      "the numbering of teeth", before.numbering, after.numbering, "label both by one numbering");
}

std::vector<ToothChange> tooth_changes(const RecordedBody& before, const RecordedBody& after) {
  if (before.teeth.empty() || after.teeth.empty()) return {};
  std::map<int, ToothChange> teeth;
  for (const RecordedTooth& tooth : before.teeth) teeth[tooth.number].before = tooth;
  for (const RecordedTooth& tooth : after.teeth) teeth[tooth.number].after = tooth;
  std::vector<ToothChange> changes;
  for (auto& [number, change] : teeth) {
    change.number = number;
    changes.push_back(change);
  }
  return changes;
}

void require_common_tooth(const BiteComparison& made, const std::vector<ToothChange>& teeth,
                          const char* role) {
  if (teeth.empty()) return;
  const bool common = std::any_of(teeth.begin(), teeth.end(), [](const ToothChange& each) {
    return each.before.has_value() && each.after.has_value();
  });
  refuse_if(!common, made.after.name,
            "the {} body has no tooth that it has in {}: label both by the same file", role,
            made.before.name);
}

// The contacts with the teeth that they are matched by: the fixed body's, else the moving one's.
std::vector<PlacedContact> placed(const BiteRecord& bite, bool by_fixed, bool by_moving) {
  std::vector<PlacedContact> contacts;
  for (const RecordedContact& each : bite.contacts) {
    contacts.push_back({each.centre, by_fixed    ? each.fixed_tooth
                                     : by_moving ? each.moving_tooth
                                                 : 0});
  }
  return contacts;
}

void match(BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  const bool by_fixed = !made.fixed.teeth.empty(), by_moving = !made.moving.teeth.empty();
  const double mm = before.units_per_mm;
  for (const ContactMatch& one :
       match_contacts(placed(before, by_fixed, by_moving), placed(after, by_fixed, by_moving),
                      made.questions.within * mm)) {
    ContactChange change;
    if (one.before) change.before = &before.contacts[*one.before];
    if (one.after) change.after = &after.contacts[*one.after];
    change.moved = one.moved;
    change.fate = !one.after                              ? ContactFate::kLost
                  : !one.before                           ? ContactFate::kNew
                  : one.moved > made.questions.moved * mm ? ContactFate::kMoved
                                                          : ContactFate::kKept;
    made.contacts.push_back(change);
  }
}

void add_notes(BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  for (const BiteRecord* bite : {&before, &after}) {
    const char* which = bite == &before ? "the first bite" : "the second bite";
    if (!bite->warning.empty()) made.notes.push_back(fmt::format("{}: {}", which, bite->warning));
    if (bite->contacts.empty()) made.notes.push_back(fmt::format("{} has no contact", which));
  }
  if (before.unit_assumed || after.unit_assumed) {
    made.notes.push_back(fmt::format("unit: {} (assumed)", before.unit));
  }
  if (!made.same_limits()) {
    made.notes.emplace_back("areas within limits are left out: the bites have different presets");
  }
  if (!made.same_sides()) {
    made.notes.emplace_back("shares by side are left out: the bites have different sides");
  }
  const bool one_labelled = before.fixed.teeth.empty() != after.fixed.teeth.empty() ||
                            before.moving.teeth.empty() != after.moving.teeth.empty();
  if (one_labelled) made.notes.emplace_back("teeth are left out: only one bite has labels");
}

}  // namespace

const char* to_string(ContactFate fate) {
  switch (fate) {
    case ContactFate::kKept:
      return "kept";
    case ContactFate::kMoved:
      return "moved";
    case ContactFate::kLost:
      return "lost";
    case ContactFate::kNew:
      return "new";
  }
  return "";
}

std::string ContactChange::teeth() const {
  const RecordedContact& of = after != nullptr ? *after : *before;
  if (of.fixed_tooth == 0 && of.moving_tooth == 0) return "";
  const auto word = [](int tooth) { return tooth == 0 ? "-" : fmt::format("{}", tooth); };
  return word(of.fixed_tooth) + "/" + word(of.moving_tooth);
}

std::size_t BiteComparison::count(ContactFate fate) const {
  return static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(),
                    [fate](const ContactChange& each) { return each.fate == fate; }));
}

std::optional<DistanceInterval> BiteComparison::depth_change() const {
  if (!before.depth || !after.depth) return {};
  if (same_pose()) return DistanceInterval{0, 0};
  return DistanceInterval{after.depth->lower - before.depth->upper,
                          after.depth->upper - before.depth->lower};
}

DistanceInterval BiteComparison::distance_change() const {
  if (same_pose()) return {0, 0};
  return {after.distance.lower - before.distance.upper,
          after.distance.upper - before.distance.lower};
}

bool BiteComparison::same_pose() const { return before.pose.matrix() == after.pose.matrix(); }

bool BiteComparison::same_sides() const {
  const auto differ = [](const auto& one, const auto& other) {
    return !one.first.empty() && !other.first.empty() && one != other;
  };
  return !differ(before.side_names, after.side_names) &&
         !differ(before.fore_aft_names, after.fore_aft_names);
}

void compare(BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  require_same(before, after);
  made.about_named = made.questions.about.has_value();
  made.motion = pose_change(before.pose, after.pose,
                            made.questions.about.value_or(before.moving.box.center()));
  made.fixed.teeth = tooth_changes(before.fixed, after.fixed);
  made.moving.teeth = tooth_changes(before.moving, after.moving);
  require_common_tooth(made, made.fixed.teeth, "fixed");
  require_common_tooth(made, made.moving.teeth, "moving");
  match(made);
  add_notes(made);
}

}  // namespace ist::answers
