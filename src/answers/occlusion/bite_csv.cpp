#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "answers/occlusion/bite_files.h"
#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/map_statistics.h"
#include "answers/refusals.h"

namespace ist::answers {
namespace {

using Number = std::optional<double>;

// To four significant digits; empty if it is not finite.
Number rounded(double number) {
  if (!std::isfinite(number)) return {};
  return numbers_of(fmt::format("{:.4g}", number))->front() + 0.0;  // -0 becomes 0
}

// Returns the next number of four significant digits above or below, or the number itself.
Number rounded_outwards(double number, bool up) {
  const Number nearest = rounded(number);
  if (!nearest || number == 0 || (up ? *nearest >= number : *nearest <= number)) return nearest;
  const double digit = std::pow(10, std::floor(std::log10(std::abs(number))) - 3);
  return rounded(*nearest + (up ? digit : -digit));
}

// A row of the table. Cells without a number stay empty.
struct Row {
  const char* kind;
  std::optional<const char*> body{};
  std::optional<std::size_t> contact{};
  std::optional<std::string> name{};
  Number from_um{}, to_um{}, area{}, overlap{}, depth{}, depth_upper{}, at_vertices{},
      depth_integral{}, least{};
  std::array<Number, 3> shares{};  // of the foundation, a thinner and a thicker one; per cent
  std::optional<Eigen::Vector3d> centre{}, closest{};
  Number value{};  // of a map
};

// Writes rows in millimetres and micrometres.
class BiteTable {
 public:
  BiteTable(const Bite& bite, OutputFile& file, DecimalSign sign)
      : bite_(bite),
        table_(file,
               {"kind",
                "body",
                "contact",
                "name",
                "from_um",
                "to_um",
                "area_mm2",
                "overlap_mm2",
                "depth_mm",
                "depth_upper_mm",
                "depth_at_vertices_mm",
                "depth_integral_mm3",
                "least_distance_um",
                "share_percent",
                "share_thinner_percent",
                "share_thicker_percent",
                "centre_x_mm",
                "centre_y_mm",
                "centre_z_mm",
                "closest_x_mm",
                "closest_y_mm",
                "closest_z_mm",
                "value_um"},
               sign) {}

  void add(const Row& row) {
    const double mm = 1 / bite_.units_per_mm;
    table_.add(row.kind);
    table_.add(row.body);
    table_.add(row.contact);
    table_.add(row.name);
    table_.add(row.from_um);
    table_.add(row.to_um);
    add_scaled(row.area, mm * mm);
    add_scaled(row.overlap, mm * mm);
    table_.add(row.depth ? rounded_outwards(mm * *row.depth, false) : Number());
    table_.add(row.depth_upper ? rounded_outwards(mm * *row.depth_upper, true) : Number());
    add_scaled(row.at_vertices, mm);
    add_scaled(row.depth_integral, mm * mm * mm);
    add_scaled(row.least, 1e3 * mm);
    for (const Number& share : row.shares) add_scaled(share, 1);
    for (const auto& place : {row.centre, row.closest}) {
      for (int axis = 0; axis < 3; ++axis) {
        table_.add(place ? Number(std::round(100 * mm * (*place)[axis]) / 100 + 0.0) : Number());
      }
    }
    add_scaled(row.value, 1e3 * mm);
    table_.end_row();
  }
  void flush() { table_.flush(); }

 private:
  void add_scaled(const Number& number, double factor) {
    table_.add(number ? rounded(factor * *number) : Number());
  }

  const Bite& bite_;
  CsvWriter table_;
};

std::array<Number, 3> percent(double share, double thinner, double thicker) {
  return {100 * share, 100 * thinner, 100 * thicker};
}

void add_totals(BiteTable& table, const Bite& bite) {
  const Depth& depth = bite.findings.depth;
  Row both{"total", "both"};
  both.area = 0;
  for (const BiteBody* body : {&bite.fixed, &bite.moving}) {
    for (const ContactRegion& region : body->surface.regions) *both.area += 0.5 * region.area;
  }
  both.overlap = depth.area;
  if (depth.certain) {
    both.depth = depth.certain->lower;
    both.depth_upper = depth.certain->upper;
  }
  both.at_vertices = bite.known_depth(depth.at_vertices.value_or(0));
  if (bite.findings.touch == Answer::kNo) both.least = bite.findings.distance->upper;
  table.add(both);
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    const SurfaceOcclusion& surface = body->surface;
    Row row{"total", role};
    row.name = body->name;
    row.area = 0;
    for (const ContactRegion& region : surface.regions) {
      *row.area += region.area;
      row.least = std::min(row.least.value_or(region.least_distance), region.least_distance);
    }
    row.overlap = surface.penetrating_area;
    row.at_vertices = bite.known_depth(surface.depth_at_vertices);
    row.depth_integral = surface.depth_integral;
    if (body->sides) row.centre = body->sides->centre;
    table.add(row);
  }
}

void add_bands(BiteTable& table, const Bite& bite) {
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    Row row{"band", role};
    const auto add = [&](Number from, double to, double area) {
      row.from_um = from;
      row.to_um = to;
      row.area = area;
      table.add(row);
    };
    add({}, 0, body->surface.penetrating_area);
    for (std::size_t i = 0; i < body->areas.size(); ++i) {
      const double limit = bite.preset->micrometres[i];
      if (limit == 0) continue;
      add({}, limit, body->areas[i]);
      add(0, limit, body->area_outside(i));
    }
  }
}

// How the distances of each body are distributed.
void add_maps(BiteTable& table, const Bite& bite) {
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    const std::optional<MapStatistics> map = map_statistics(*body, bite);
    if (!map) continue;
    const auto add = [&, role = role](const std::string& name, double value) {
      Row row{"map", role};
      row.name = name;
      row.value = value;
      table.add(row);
    };
    add("mean", map->mean);
    add("standard deviation", map->deviation);
    add("root mean square", map->root_mean_square);
    add("least", map->least);
    for (std::size_t i = 0; i < kPercentiles.size(); ++i) {
      add(fmt::format("percentile {}", kPercentiles[i]), map->percentiles[i]);
    }
    add("most", map->most);
    for (std::size_t i = 0; i < map->histogram.size(); ++i) {
      const double unit = bite.units_per_micrometre();
      const double from = map->from + static_cast<double>(i) * map->step;
      Row row{"histogram", role};
      row.from_um = rounded(from / unit);
      row.to_um = rounded((from + map->step) / unit);
      row.area = map->histogram[i];
      table.add(row);
    }
  }
}

void add_sides(BiteTable& table, const Bite& bite) {
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    for (const auto& [balance, division] :
         {std::pair(&body->sides, &bite.sides), {&body->fore_aft, &bite.fore_aft}}) {
      if (!*balance) continue;
      const Balance& of = **balance;
      Row row{"side", role};
      row.name = division->first;
      row.shares = {of.shares.first, of.thinner.first, of.thicker.first};
      table.add(row);
      row.name = division->second;
      row.shares = {of.shares.second, of.thinner.second, of.thicker.second};
      table.add(row);
    }
  }
}

void add_teeth(BiteTable& table, const Bite& bite) {
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    for (const Tooth& tooth : body->teeth) {
      Row row{"tooth", role};
      row.name = fmt::format("{}", tooth.number);
      row.area = tooth.area;
      row.least = tooth.least_distance;
      row.shares = percent(tooth.share, tooth.share_thinner, tooth.share_thicker);
      table.add(row);
    }
  }
}

// A contact and a region have the same measures.
template <typename Part>
void add_part(BiteTable& table, Row row, const Part& part) {
  row.area = part.area;
  row.overlap = part.penetrating_area;
  row.depth_integral = part.depth_integral;
  row.least = part.least_distance;
  row.shares = percent(part.share, part.share_thinner, part.share_thicker);
  row.centre = part.centre;
  row.closest = part.closest;
  table.add(row);
}

void add_contacts(BiteTable& table, const Bite& bite) {
  for (std::size_t i = 0; i < bite.contacts.size(); ++i) {
    if (bite.contacts[i].on_both()) add_part(table, {"pair", "both", i + 1}, bite.contacts[i]);
  }
  for (const auto& [body, role] : {std::pair(&bite.fixed, "fixed"), {&bite.moving, "moving"}}) {
    for (std::size_t k = 0; k < body->contacts.size(); ++k) {
      add_part(table, {"region", role, body->contacts[k]}, body->surface.regions[k]);
    }
  }
}

}  // namespace

void write_bite_csv(const Bite& bite, DecimalSign sign, OutputFile& file) {
  file.write("\xEF\xBB\xBF", 3);
  BiteTable table(bite, file, sign);
  add_totals(table, bite);
  add_bands(table, bite);
  add_maps(table, bite);
  add_sides(table, bite);
  add_teeth(table, bite);
  add_contacts(table, bite);
  for (const std::string& note : notes_of(bite)) {
    Row row{"note"};
    row.name = note;
    table.add(row);
  }
  table.flush();
}

}  // namespace ist::answers
