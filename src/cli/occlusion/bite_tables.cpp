#include "cli/occlusion/bite_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/answers/json_text.h"
#include "cli/formats/csv_writer.h"
#include "cli/occlusion/bite_json.h"
#include "cli/terminal.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

void add_rows(CsvWriter& table, const Bite& bite, const BiteBody& body, const char* role) {
  std::size_t index = 0;
  for (const ContactRegion& region : body.surface.regions) {
    table.row(role, index++, region.area, region.centre[0], region.centre[1], region.centre[2],
              region.least_distance, region.closest[0], region.closest[1], region.closest[2],
              region.penetrating_area, region.depth_integral, region.share, region.share_thinner,
              region.share_thicker, region.partner, bite.unit_words());
  }
}

// How far apart, and how deep: of a body that lies inside the other both are known.
std::string first_line(const Bite& bite) {
  const Findings& found = bite.findings;
  const bool yes = found.touch == Answer::kYes;
  std::string line = "touch " + (yes ? painted("yes", TextColour::kRed) : to_string(found.touch));
  if (found.inside && *found.inside != Inside::kNone) {
    line += fmt::format(", the {} body lies inside the other", to_string(*found.inside));
  }
  if (!yes) {
    line += fmt::format(", {:.4g} to {:.4g} {} apart", found.distance->lower, found.distance->upper,
                        bite.unit);
  }
  const Depth& depth = found.depth;
  if (depth.certain && depth.certain->upper > 0) {
    line += fmt::format(", {:.4g} to {:.4g} {} deep", depth.certain->lower, depth.certain->upper,
                        bite.unit);
  } else if (!depth.certain && (yes || depth.at_vertices > 0.0)) {
    line += fmt::format("{} at least {:.3g} {} deep (open surface, by vertices)",
                        yes ? "," : ", or", depth.at_vertices.value_or(0.0), bite.unit);
  }
  return line + fmt::format(" (± {:g} {} assumed for scanning)",
                            bite.scanner_band * bite.units_per_micrometre(), bite.unit);
}

std::string second_line(const Bite& bite) {
  std::string areas;
  for (std::size_t i = 0; i < bite.fixed.areas.size(); ++i) {
    const double limit = bite.preset->micrometres[i];
    areas += fmt::format(
        "{}{} {:.4g} and {:.4g} {}²{}", areas.empty() ? "" : ", ",
        limit > 0 ? fmt::format("within {:g} µm", limit) : "in each other", bite.fixed.areas[i],
        bite.moving.areas[i], bite.unit,
        limit > 0 && limit < bite.scanner_band ? " (below the error assumed for scanning)" : "");
  }
  const auto unpaired = [](const BiteBody& body) {
    return std::count_if(body.surface.regions.begin(), body.surface.regions.end(),
                         [](const ContactRegion& region) { return !region.partner; });
  };
  const auto pairs =
      static_cast<std::ptrdiff_t>(bite.fixed.surface.regions.size()) - unpaired(bite.fixed);
  return fmt::format("areas, {} ({}): {}; {} paired region{}, {} unpaired", bite.preset->name,
                     bite.preset->source, areas, pairs, pairs == 1 ? "" : "s",
                     unpaired(bite.fixed) + unpaired(bite.moving));
}

}  // namespace

void write_bite_csv(const Bite& bite, OutputFile& file) {
  CsvWriter table(
      file, {"body", "index", "area", "centre_x", "centre_y", "centre_z", "least_distance",
             "closest_x", "closest_y", "closest_z", "penetrating_area", "depth_integral", "share",
             "share_thinner", "share_thicker", "partner", "unit"});
  add_rows(table, bite, bite.fixed, "fixed");
  add_rows(table, bite, bite.moving, "moving");
  table.flush();
}

void write_bite_json(const Bite& bite, OutputFile& file) {
  const std::string text = json_text(json_of(bite), 2) + "\n";
  file.write(text.data(), text.size());
}

void print_bite(const Bite& bite, std::span<const std::filesystem::path> written) {
  std::string last = "checks: ";
  for (const std::string& check : bite.checks) last += check + "; ";
  last += written.empty() ? "nothing written" : "wrote";
  for (const std::filesystem::path& file : written) last += " " + file.string();
  fmt::print("{}\n{}\n{}\n", first_line(bite), second_line(bite), last);
}

}  // namespace ist::cli
