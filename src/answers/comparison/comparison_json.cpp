#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "answers/commit.h"
#include "answers/comparison/comparison_files.h"
#include "answers/json_parts.h"
#include "answers/occlusion/bite.h"

namespace ist::answers {
namespace {

using nlohmann::ordered_json;

ordered_json known_or_null(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json interval(const std::optional<DistanceInterval>& of) {
  return of ? ordered_json{of->lower, of->upper} : ordered_json(nullptr);
}

// The number before and after, and its change; null if a bite lacks it.
ordered_json change_of(const std::optional<double>& before, const std::optional<double>& after) {
  ordered_json out{{"before", known_or_null(before)}, {"after", known_or_null(after)}};
  out["change"] = before && after ? ordered_json(*after - *before) : ordered_json(nullptr);
  return out;
}

ordered_json source_json(const RecordedBody& body) {
  return {{"file", body.name},
          {"hash", body.hash.empty() ? ordered_json(nullptr) : ordered_json(body.hash)}};
}

ordered_json motion_json(const BiteComparison& made) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const PoseChange& motion = made.motion;
  return {{"about", point_json(motion.about)},
          {"about_named", made.about_named},
          {"translation", point_json(motion.translation)},
          {"rotation_degrees", point_json(Eigen::Vector3d(kDegrees * motion.rotation))},
          {"screw",
           {{"axis", point_json(motion.axis)},
            {"point", point_json(motion.axis_point)},
            {"angle_degrees", kDegrees * motion.angle},
            {"along", motion.along}}}};
}

ordered_json contact_json(const RecordedContact* contact) {
  if (contact == nullptr) return nullptr;
  const auto tooth = [](int number) {
    return number == 0 ? ordered_json(nullptr) : ordered_json(number);
  };
  return {{"number", contact->number},
          {"on_fixed", contact->on_fixed},
          {"on_moving", contact->on_moving},
          {"area", contact->area},
          {"penetrating_area", contact->overlap},
          {"depth", contact->depth()},
          {"least_distance", contact->least_distance},
          {"share", contact->share},
          {"centre", point_json(contact->centre)},
          {"closest", point_json(contact->closest)},
          {"teeth",
           {{"fixed", tooth(contact->fixed_tooth)}, {"moving", tooth(contact->moving_tooth)}}}};
}

ordered_json contact_json(const ContactChange& contact) {
  ordered_json out{{"fate", to_string(contact.fate)},
                   {"before", contact_json(contact.before)},
                   {"after", contact_json(contact.after)},
                   {"moved", nullptr},
                   {"change", nullptr}};
  if (contact.before == nullptr || contact.after == nullptr) return out;
  const RecordedContact &before = *contact.before, &after = *contact.after;
  out["moved"] = contact.moved;
  out["change"] = {{"area", after.area - before.area},
                   {"penetrating_area", after.overlap - before.overlap},
                   {"depth", after.depth() - before.depth()},
                   {"least_distance", after.least_distance - before.least_distance},
                   {"share", after.share - before.share},
                   {"centre", point_json(Eigen::Vector3d(after.centre - before.centre))}};
  return out;
}

ordered_json tooth_json(const ToothChange& tooth) {
  const auto member = [](const std::optional<RecordedTooth>& of, double RecordedTooth::*which) {
    return of ? std::optional((*of).*which) : std::nullopt;
  };
  const auto least = [](const std::optional<RecordedTooth>& of) {
    return of ? of->least_distance : std::nullopt;
  };
  return {{"number", tooth.number},
          {"area", change_of(member(tooth.before, &RecordedTooth::area),
                             member(tooth.after, &RecordedTooth::area))},
          {"share", change_of(member(tooth.before, &RecordedTooth::share),
                              member(tooth.after, &RecordedTooth::share))},
          {"least_distance", change_of(least(tooth.before), least(tooth.after))}};
}

ordered_json sides_json(const std::vector<double>& before, const std::vector<double>& after,
                        const std::pair<std::string, std::string>& names) {
  const auto share = [](const std::vector<double>& shares, std::size_t i) {
    return shares.empty() ? std::nullopt : std::optional(shares[i]);
  };
  if (before.empty() && after.empty()) return nullptr;
  return {{names.first, change_of(share(before, 0), share(after, 0))},
          {names.second, change_of(share(before, 1), share(after, 1))}};
}

ordered_json body_json(const BiteComparison& made, const RecordedBody& before,
                       const RecordedBody& after, const BodyChange& change) {
  ordered_json out{{"area", change_of(before.area, after.area)},
                   {"penetrating_area", change_of(before.overlap, after.overlap)},
                   {"depth_integral", change_of(before.depth_integral, after.depth_integral)},
                   {"depth_at_vertices", change_of(before.deepest, after.deepest)}};
  out["areas"] = ordered_json::array();
  for (std::size_t i = 0; made.same_limits() && i < before.areas.size(); ++i) {
    ordered_json area{{"micrometres", made.before.limits[i]}};
    area.update(change_of(before.areas[i], after.areas[i]));
    out["areas"].push_back(area);
  }
  const auto names = [](const auto& one, const auto& other) {
    return one.first.empty() ? other : one;
  };
  out["sides"] = nullptr;
  out["fore_aft"] = nullptr;
  if (made.same_sides()) {
    out["sides"] =
        sides_json(before.side, after.side, names(made.before.side_names, made.after.side_names));
    out["fore_aft"] = sides_json(before.fore_aft, after.fore_aft,
                                 names(made.before.fore_aft_names, made.after.fore_aft_names));
  }
  out["teeth"] = ordered_json::array();
  for (const ToothChange& tooth : change.teeth) out["teeth"].push_back(tooth_json(tooth));
  return out;
}

}  // namespace

ordered_json json_of(const BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  ordered_json out{{"schema", 1},
                   {"version", IST_VERSION},
                   {"commit", IST_COMMIT},
                   {"unit", before.unit},
                   {"unit_assumed", before.unit_assumed}};
  out["frame"] = before.frame.empty() ? ordered_json(nullptr) : ordered_json(before.frame);
  out["bodies"] = {{"fixed", source_json(before.fixed)}, {"moving", source_json(before.moving)}};
  out["poses"] = {{"before", pose_json(before.pose)}, {"after", pose_json(after.pose)}};
  out["motion"] = motion_json(made);
  out["within_mm"] = made.questions.within;
  out["moved_mm"] = made.questions.moved;
  out["touch"] = {{"before", before.touch}, {"after", after.touch}};
  out["distance"] = {{"before", interval(before.distance)},
                     {"after", interval(after.distance)},
                     {"change", interval(made.distance_change())}};
  out["depth"] = {{"before", interval(before.depth)},
                  {"after", interval(after.depth)},
                  {"change", interval(made.depth_change())}};
  out["fixed"] = body_json(made, before.fixed, after.fixed, made.fixed);
  out["moving"] = body_json(made, before.moving, after.moving, made.moving);
  out["count"] = {{"before", before.contacts.size()}, {"after", after.contacts.size()}};
  for (const ContactFate fate :
       {ContactFate::kKept, ContactFate::kMoved, ContactFate::kLost, ContactFate::kNew}) {
    out["count"][to_string(fate)] = made.count(fate);
  }
  out["contacts"] = ordered_json::array();
  for (const ContactChange& contact : made.contacts) {
    out["contacts"].push_back(contact_json(contact));
  }
  out["notes"] = made.notes;
  out["caveat"] = kCaveat;
  return out;
}

void write_comparison_json(const BiteComparison& comparison, OutputFile& file) {
  const std::string text = json_text(json_of(comparison), 2) + "\n";
  file.write(text.data(), text.size());
}

}  // namespace ist::answers
