#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "answers/comparison/comparison_files.h"
#include "answers/refusals.h"

namespace ist::answers {
namespace {

using Measure = std::optional<double>;

// A measure of both bites, mesh units.
struct Both {
  Measure before{}, after{};
};

// A row of the table. Cells without a number stay empty.
struct ChangeRow {
  const char* kind;
  std::optional<std::string> name{}, fate{}, body{}, teeth{};
  std::optional<std::size_t> before{}, after{};  // numbers of a contact
  Measure value{}, moved{};
  Both area{}, overlap{}, depth{}, least{}, share{};  // share: per cent
  std::optional<Eigen::Vector3d> centre_before{}, centre_after{};
};

// To four significant digits; empty if it is not finite.
Measure four_digits(double number) {
  if (!std::isfinite(number)) return {};
  return numbers_of(fmt::format("{:.4g}", number))->front() + 0.0;  // -0 becomes 0
}

class ChangeTable {
 public:
  ChangeTable(const BiteComparison& made, OutputFile& file, DecimalSign sign)
      : mm_(1 / made.before.units_per_mm), table_(file, columns(), sign) {}

  void add(const ChangeRow& row) {
    table_.add(row.kind);
    table_.add(row.fate);
    table_.add(row.body);
    table_.add(row.name);
    table_.add(row.teeth);
    table_.add(row.before);
    table_.add(row.after);
    table_.add(row.value);
    add_scaled(row.moved, mm_);
    add_both(row.area, mm_ * mm_);
    add_both(row.overlap, mm_ * mm_);
    add_both(row.depth, mm_);
    add_both(row.least, 1e3 * mm_);
    add_both(row.share, 1);
    for (const auto& place : {row.centre_before, row.centre_after}) {
      for (int axis = 0; axis < 3; ++axis) {
        table_.add(place ? Measure(std::round(100 * mm_ * (*place)[axis]) / 100 + 0.0) : Measure());
      }
    }
    table_.end_row();
  }
  [[nodiscard]] double mm() const { return mm_; }
  void flush() { table_.flush(); }

 private:
  static std::vector<std::string> columns() {
    std::vector<std::string> columns{"kind",           "change",        "body",  "name",    "teeth",
                                     "contact_before", "contact_after", "value", "moved_mm"};
    for (const char* measure :
         {"area_{}mm2", "overlap_{}mm2", "depth_{}mm", "least_distance_{}um", "share_{}percent"}) {
      for (const char* when : {"before_", "after_", "change_"}) {
        columns.push_back(fmt::format(fmt::runtime(measure), when));
      }
    }
    for (const char* when : {"before", "after"}) {
      for (const char axis : {'x', 'y', 'z'}) {
        columns.push_back(fmt::format("centre_{}_{}_mm", when, axis));
      }
    }
    return columns;
  }
  void add_scaled(const Measure& number, double factor) {
    table_.add(number ? four_digits(factor * *number) : Measure());
  }
  void add_both(const Both& both, double factor) {
    add_scaled(both.before, factor);
    add_scaled(both.after, factor);
    add_scaled(both.before && both.after ? Measure(*both.after - *both.before) : Measure(), factor);
  }

  double mm_;  // for a mesh unit
  CsvWriter table_;
};

void add_motion(ChangeTable& table, const PoseChange& motion) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const auto add = [&](const std::string& name, Measure value) {
    ChangeRow row{"motion", name};
    row.value = value ? four_digits(*value) : Measure();
    table.add(row);
  };
  const auto triple = [&](const char* name, const char* unit,
                          const std::optional<Eigen::Vector3d>& of, double factor) {
    for (int axis = 0; axis < 3; ++axis) {
      add(fmt::format("{}_{}{}", name, "xyz"[axis], unit),
          of ? Measure(factor * (*of)[axis]) : Measure());
    }
  };
  triple("about", "_mm", motion.about, table.mm());
  triple("translation", "_mm", motion.translation, table.mm());
  triple("rotation", "_degrees", motion.rotation, kDegrees);
  triple("screw_axis", "", motion.axis, 1);
  triple("screw_point", "_mm", motion.axis_point, table.mm());
  add("screw_angle_degrees", kDegrees * motion.angle);
  add("screw_along_mm", table.mm() * motion.along);
}

// The sum over both bodies, halved; like the contacts of a bite.
Both mean(double fixed_before, double moving_before, double fixed_after, double moving_after) {
  return {0.5 * (fixed_before + moving_before), 0.5 * (fixed_after + moving_after)};
}

void add_totals(ChangeTable& table, const BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  ChangeRow both{"total"};
  both.body = "both";
  both.area = mean(before.fixed.area, before.moving.area, after.fixed.area, after.moving.area);
  both.overlap =
      mean(before.fixed.overlap, before.moving.overlap, after.fixed.overlap, after.moving.overlap);
  if (before.touch == "no") both.least.before = before.distance.upper;
  if (after.touch == "no") both.least.after = after.distance.upper;
  table.add(both);
  for (const bool fixed : {true, false}) {
    const RecordedBody &first = fixed ? before.fixed : before.moving,
                       &second = fixed ? after.fixed : after.moving;
    ChangeRow row{"total", first.name};
    row.body = fixed ? "fixed" : "moving";
    row.area = {first.area, second.area};
    row.overlap = {first.overlap, second.overlap};
    row.depth = {first.deepest, second.deepest};
    table.add(row);
    for (std::size_t i = 0; made.same_limits() && i < first.areas.size(); ++i) {
      ChangeRow band{"band", fmt::format("to {:g} um", before.limits[i])};
      band.body = row.body;
      band.area = {first.areas[i], second.areas[i]};
      table.add(band);
    }
  }
}

void add_sides(ChangeTable& table, const BiteComparison& made) {
  if (!made.same_sides()) return;
  const auto add = [&](const char* body, const std::vector<double>& before,
                       const std::vector<double>& after,
                       const std::pair<std::string, std::string>& names) {
    for (std::size_t i = 0; i < 2 && !(before.empty() && after.empty()); ++i) {
      ChangeRow row{"side", i == 0 ? names.first : names.second};
      row.body = body;
      if (!before.empty()) row.share.before = before[i];
      if (!after.empty()) row.share.after = after[i];
      table.add(row);
    }
  };
  const auto names = [](const auto& one, const auto& other) {
    return one.first.empty() ? other : one;
  };
  const auto side = names(made.before.side_names, made.after.side_names);
  const auto fore_aft = names(made.before.fore_aft_names, made.after.fore_aft_names);
  add("fixed", made.before.fixed.side, made.after.fixed.side, side);
  add("fixed", made.before.fixed.fore_aft, made.after.fixed.fore_aft, fore_aft);
  add("moving", made.before.moving.side, made.after.moving.side, side);
  add("moving", made.before.moving.fore_aft, made.after.moving.fore_aft, fore_aft);
}

void add_teeth(ChangeTable& table, const BodyChange& change, const char* body) {
  for (const ToothChange& tooth : change.teeth) {
    ChangeRow row{"tooth", fmt::format("{}", tooth.number)};
    row.body = body;
    if (tooth.before) {
      row.area.before = tooth.before->area;
      row.share.before = 100 * tooth.before->share;
      row.least.before = tooth.before->least_distance;
    }
    if (tooth.after) {
      row.area.after = tooth.after->area;
      row.share.after = 100 * tooth.after->share;
      row.least.after = tooth.after->least_distance;
    }
    table.add(row);
  }
}

void add_contact(ChangeTable& table, const ContactChange& contact) {
  ChangeRow row{"contact"};
  row.fate = to_string(contact.fate);
  const std::string teeth = contact.teeth();
  if (!teeth.empty()) row.teeth = teeth;
  const RecordedContact& of = contact.after != nullptr ? *contact.after : *contact.before;
  row.body = of.on_fixed && of.on_moving ? "both" : of.on_fixed ? "fixed" : "moving";
  const auto put = [&row](const RecordedContact* one, Measure Both::*when, auto& number,
                          auto& centre) {
    if (one == nullptr) return;
    number = one->number;
    row.area.*when = one->area;
    row.overlap.*when = one->overlap;
    row.depth.*when = one->depth();
    row.least.*when = one->least_distance;
    row.share.*when = 100 * one->share;
    centre = one->centre;
  };
  put(contact.before, &Both::before, row.before, row.centre_before);
  put(contact.after, &Both::after, row.after, row.centre_after);
  if (contact.before != nullptr && contact.after != nullptr) row.moved = contact.moved;
  table.add(row);
}

}  // namespace

void write_comparison_csv(const BiteComparison& made, DecimalSign sign, OutputFile& file) {
  file.write("\xEF\xBB\xBF", 3);
  ChangeTable table(made, file, sign);
  add_motion(table, made.motion);
  add_totals(table, made);
  add_sides(table, made);
  add_teeth(table, made.fixed, "fixed");
  add_teeth(table, made.moving, "moving");
  for (const ContactChange& contact : made.contacts) add_contact(table, contact);
  for (const std::string& note : made.notes) table.add({"note", note});
  table.flush();
}

}  // namespace ist::answers
