#include "cli/occlusion/html/html_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "cli/occlusion/html/bite_numbers.h"
#include "cli/occlusion/html/html_text.h"

namespace ist::cli {
namespace {

struct NamedBody {
  const BiteBody& body;
  const char* role;
};
std::array<NamedBody, 2> bodies_of(const Bite& bite) {
  return {{{bite.fixed, "fixed"}, {bite.moving, "moving"}}};
}

// How many vertices lie nearest to an open border.
std::size_t unsigned_vertices(const BiteBody& body) {
  return static_cast<std::size_t>(std::count_if(
      body.surface.vertices.begin(), body.surface.vertices.end(),
      [](const SurfaceDistance& d) { return !std::isnan(d.distance) && !d.is_signed; }));
}

std::string foundation_words(const Bite& bite) {
  const BiteNumbers numbers(bite);
  return fmt::format("with a foundation of {} (in brackets: {}; {})",
                     numbers.length(bite.foundation), numbers.length(bite.foundation - bite.change),
                     numbers.length(bite.foundation + bite.change));
}

// Rows of a balance; a dash in each cell where nothing is pressed.
void add_balance(HtmlTable& table, const char* role, const Division& division,
                 const std::optional<Balance>& balance) {
  const auto cells = [&](auto member) -> std::string {
    if (!balance) return "–";
    const auto of = [&](const Balance::Shares& shares) {
      return shares.first + shares.second > 0 ? fmt::format("{:.2f}", shares.*member) : "–";
    };
    return fmt::format("{} ({}; {})", of(balance->shares), of(balance->thinner),
                       of(balance->thicker));
  };
  const std::string first = escaped(division.first), second = escaped(division.second);
  table.add({fmt::format("{}: {} and {}", role, first, second),
             first + " " + cells(&Balance::Shares::first),
             second + " " + cells(&Balance::Shares::second), cells(&Balance::Shares::asymmetry),
             balance ? BiteNumbers::place(balance->centre) : "–"});
}

std::string plane_words(const Division& division) {
  const Eigen::Vector3d& n = division.direction;
  return fmt::format("{} and {} are parted by the plane {:.6g} x + {:.6g} y + {:.6g} z = {:.6g}{}",
                     escaped(division.first), escaped(division.second), n.x(), n.y(), n.z(),
                     division.at, division.assumed ? ", the middle of the box: assumed" : "");
}

}  // namespace

std::string body_table(const Bite& bite) {
  const BiteNumbers numbers(bite);
  HtmlTable table("bodies", "The two bodies",
                  {"body", "file", "XXH3 of the file", "triangles", "area, mm²", "closed",
                   "vertices without a known sign"});
  for (const auto& [body, role] : bodies_of(bite)) {
    table.add({role, escaped(body.name), body.hash ? escaped(*body.hash) : "–",
               fmt::format("{}", body.mesh->triangles.size()),
               numbers.area(body.surface.total_area),
               body.closed ? "yes" : "no: depth is by vertices",
               fmt::format("{}", unsigned_vertices(body))});
  }
  return table.html();
}

std::string pose_table(const Bite& bite) {
  HtmlTable table("pose", "Pose: from coordinates of the moving file to those of the fixed one",
                  {"", "x", "y", "z", "shift"});
  const Eigen::Matrix4d matrix = bite.pose.matrix();
  const std::array<const char*, 4> rows{"x", "y", "z", ""};
  for (int i = 0; i < 4; ++i) {
    std::vector<std::string> cells{rows[static_cast<std::size_t>(i)]};
    for (int k = 0; k < 4; ++k) cells.push_back(fmt::format("{}", matrix(i, k)));
    table.add(cells);
  }
  return table.html();
}

std::string findings_table(const Bite& bite) {
  const BiteNumbers numbers(bite);
  const Findings& found = bite.findings;
  HtmlTable table("findings", "", {"question", "answer"});
  table.add({"do the surfaces touch", to_string(found.touch)});
  if (found.inside && *found.inside != Inside::kNone) {
    table.add({"inside the other", fmt::format("the {} body", to_string(*found.inside))});
  }
  if (found.triangle_pairs) {
    table.add({"pairs of triangles that intersect", fmt::format("{}", *found.triangle_pairs)});
  }
  if (found.distance) table.add({"distance of the surfaces", numbers.interval(*found.distance)});
  const Depth& depth = found.depth;
  if (depth.certain) table.add({"penetration depth", numbers.interval(*depth.certain)});
  if (depth.at_vertices) {
    table.add({depth.certain ? "depth of the deepest vertex"
                             : "depth of the deepest vertex (open surfaces: at least)",
               numbers.length(*depth.at_vertices)});
  }
  if (depth.area)
    table.add({"area inside the other body, mean of both", numbers.area(*depth.area) + " mm²"});
  if (depth.point) table.add({"deepest point", BiteNumbers::place(*depth.point)});
  for (const std::string& note : found.notes) table.add({"note", escaped(note)});
  return table.html();
}

std::string area_table(const Bite& bite) {
  const BiteNumbers numbers(bite);
  HtmlTable table("areas", "Areas of each surface by its distance from the other one",
                  {"where", "fixed", "moving", "unit"});
  const BiteBody &fixed = bite.fixed, &moving = bite.moving;
  for (std::size_t i = 0; i < bite.preset->micrometres.size(); ++i) {
    const double limit = bite.preset->micrometres[i];
    if (limit == 0) continue;  // the overlap
    table.add(
        {fmt::format("distance at most {:g} µm{}", limit,
                     limit < bite.scanner_band ? ": below the error assumed for scanning" : ""),
         numbers.area(fixed.areas[i]), numbers.area(moving.areas[i]), "mm²"});
  }
  table.add({"overlap", numbers.area(fixed.surface.penetrating_area),
             numbers.area(moving.surface.penetrating_area), "mm²"});
  table.add({"depth, integrated over the overlap (no volume)",
             numbers.volume(fixed.surface.depth_integral),
             numbers.volume(moving.surface.depth_integral), "mm³"});
  table.add({"depth of the deepest vertex", numbers.micrometres(fixed.surface.depth_at_vertices),
             numbers.micrometres(moving.surface.depth_at_vertices), "µm"});
  return table.html();
}

std::string share_table(const Bite& bite) {
  HtmlTable table(
      "shares", "Geometric share by side, " + foundation_words(bite),
      {"surface and sides", "first side, %", "second side, %", "asymmetry, %", "centre"});
  for (const auto& [body, role] : bodies_of(bite)) {
    add_balance(table, role, bite.sides, body.sides);
    add_balance(table, role, bite.fore_aft, body.fore_aft);
  }
  return fmt::format("{}<p>{}; {}. Asymmetry is 100 |a − b| / (a + b).</p>\n", table.html(),
                     plane_words(bite.sides), plane_words(bite.fore_aft));
}

std::string tooth_table(const Bite& bite) {
  const BiteNumbers numbers(bite);
  const char* system = !bite.numbers                               ? ""
                       : *bite.numbers == ToothNumbers::kUniversal ? ", universal numbers"
                                                                   : ", FDI numbers";
  HtmlTable table(
      "teeth", fmt::format("Teeth{}: {}", system, foundation_words(bite)),
      {"tooth", "body", "area in contact, mm²", "geometric share, %", "least distance, µm"});
  for (const auto& [body, role] : bodies_of(bite)) {
    for (const Tooth& tooth : body.teeth) {
      table.add({fmt::format("{}", tooth.number), role, numbers.area(tooth.area),
                 BiteNumbers::share(100 * tooth.share, 100 * tooth.share_thinner,
                                    100 * tooth.share_thicker),
                 numbers.micrometres(tooth.least_distance)});
    }
  }
  return table.empty() ? "" : table.html();
}

std::string region_tables(const Bite& bite) {
  const BiteNumbers numbers(bite);
  const std::vector<std::string> head{"region",
                                      "partner",
                                      "area, mm²",
                                      "share, %",
                                      "least distance, µm",
                                      "overlap, mm²",
                                      "depth, integrated, mm³",
                                      "centre",
                                      "closest point"};
  const std::string caption = fmt::format("distance at most {}; share {}",
                                          numbers.length(bite.contact), foundation_words(bite));
  HtmlTable paired("regions", "Contact regions with a partner: " + caption, head);
  HtmlTable unpaired("unpaired", "Unpaired contact regions: " + caption, head);
  for (const auto& [body, role] : bodies_of(bite)) {
    const char* other = &body == &bite.fixed ? "moving" : "fixed";
    const auto& regions = body.surface.regions;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const ContactRegion& region = regions[i];
      (region.partner ? paired : unpaired)
          .add({fmt::format("{} {}", role, i),
                region.partner ? fmt::format("{} {}", other, *region.partner) : "unpaired",
                numbers.area(region.area),
                BiteNumbers::share(100 * region.share, 100 * region.share_thinner,
                                   100 * region.share_thicker),
                numbers.micrometres(region.least_distance), numbers.area(region.penetrating_area),
                numbers.volume(region.depth_integral), BiteNumbers::place(region.centre),
                BiteNumbers::place(region.closest)});
    }
  }
  const auto or_none = [](const HtmlTable& table, const char* none) {
    return table.empty() ? fmt::format("<p>{}</p>\n", none) : table.html();
  };
  return or_none(paired, "No contact region has a partner.") +
         or_none(unpaired, "No contact region is without a partner.");
}

}  // namespace ist::cli
