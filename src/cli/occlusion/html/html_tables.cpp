#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "answers/occlusion/bite_numbers.h"
#include "cli/occlusion/html/html_parts.h"
#include "cli/occlusion/html/html_text.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr const char* kNoContacts = "<p>No contacts.</p>\n";

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
void add_balance(HtmlTable& table, const BiteNumbers& numbers, const char* role,
                 const Division& division, const std::optional<Balance>& balance) {
  const auto cells = [&](auto member) -> std::string {
    if (!balance) return "–";
    const auto of = [&](const Balance::Shares& shares) {
      return shares.first + shares.second > 0 ? BiteNumbers::percent(shares.*member) : "–";
    };
    return fmt::format("{} ({}; {})", of(balance->shares), of(balance->thinner),
                       of(balance->thicker));
  };
  const std::string first = escaped(division.first), second = escaped(division.second);
  table.add({fmt::format("{}: {} and {}", role, first, second),
             first + " " + cells(&Balance::Shares::first),
             second + " " + cells(&Balance::Shares::second), cells(&Balance::Shares::asymmetry),
             balance ? numbers.place(balance->centre) : "–"});
}

// The plane that parts both sides: "x = 0.01", or "0.6 x + 0.8 y = 2".
std::string plane_of(const Division& division, const BiteNumbers& numbers) {
  const Eigen::Vector3d& n = division.direction;
  Eigen::Index axis = 0;
  if (n.cwiseAbs().maxCoeff(&axis) > 1 - 1e-9) {
    return fmt::format("{} = {}", "xyz"[axis], numbers.coordinate(division.at / n[axis]));
  }
  std::string plane;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(n[i]) < 1e-9) continue;
    plane += fmt::format("{}{:.4g} {}", plane.empty() ? "" : " + ", n[i], "xyz"[i]);
  }
  return plane + " = " + numbers.coordinate(division.at);
}

std::string plane_words(const Division& division, const Bite& bite) {
  const BiteNumbers numbers(bite);
  const char* const middle = !division.assumed ? ""
                             : bite.region
                                 ? "the middle of the fixed body's box within the region, "
                                 : "the middle of the fixed body, ";
  return fmt::format("{} and {}: split at {}{}", escaped(division.first), escaped(division.second),
                     middle, plane_of(division, numbers) + (division.assumed ? " (assumed)" : ""));
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
  if (depth.area) {
    table.add(
        {depth.certain ? "depth of the deepest vertex"
                       : "depth of the deepest vertex (open surfaces: at least)",
         depth.at_vertices ? numbers.length(*depth.at_vertices) : "not known (open surface)"});
  }
  if (depth.area)
    table.add({"area inside the other body, mean of both", numbers.area(*depth.area) + " mm²"});
  if (depth.point)
    table.add({bite.region ? "deepest vertex in the region" : "deepest point",
               numbers.place(*depth.point) + " " + escaped(bite.unit)});
  for (const std::string& note : found.notes) table.add({"note", escaped(note)});
  return table.html();
}

std::string area_table(const Bite& bite) {
  const BiteNumbers numbers(bite);
  HtmlTable table("areas", "Areas of each surface by its distance from the other one",
                  {"distance from the other surface", "fixed, mm²", "moving, mm²"});
  const BiteBody &fixed = bite.fixed, &moving = bite.moving;
  table.add({"overlap", numbers.area(fixed.surface.penetrating_area),
             numbers.area(moving.surface.penetrating_area)});
  for (std::size_t i = 0; i < bite.preset->micrometres.size(); ++i) {
    const double limit = bite.preset->micrometres[i];
    if (limit == 0) continue;  // the overlap
    const char* error = limit < bite.scanner_band ? ": below the error assumed for scanning" : "";
    table.add({fmt::format("within {:g} µm or overlapping{}", limit, error),
               numbers.area(fixed.areas[i]), numbers.area(moving.areas[i])});
    table.add({fmt::format("within {:g} µm, without the overlap{}", limit, error),
               numbers.area(fixed.area_outside(i)), numbers.area(moving.area_outside(i))});
  }
  HtmlTable depths("depths", "Overlap of each surface",
                   {"surface", "depth of the deepest vertex, µm",
                    "depth, integrated over the overlap (no volume), mm³"});
  for (const auto& [body, role] : bodies_of(bite)) {
    const std::optional<double> deepest = bite.known_depth(body.surface.depth_at_vertices);
    depths.add({role, deepest ? numbers.micrometres(*deepest) : "not known",
                numbers.volume(body.surface.depth_integral)});
  }
  return table.html() + depths.html();
}

std::string share_table(const Bite& bite) {
  if (bite.contacts.empty()) return kNoContacts;
  const BiteNumbers numbers(bite);
  HtmlTable table("shares", "Geometric share by side, " + foundation_words(bite),
                  {"surface and sides", "first side, %", "second side, %", "asymmetry, %",
                   "centre, " + escaped(bite.unit)});
  for (const auto& [body, role] : bodies_of(bite)) {
    add_balance(table, numbers, role, bite.sides, body.sides);
    add_balance(table, numbers, role, bite.fore_aft, body.fore_aft);
  }
  return fmt::format("{}<p>{}; {}. Asymmetry is 100 |a − b| / (a + b).</p>\n", table.html(),
                     plane_words(bite.sides, bite), plane_words(bite.fore_aft, bite));
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

std::string contact_tables(const Bite& bite) {
  if (bite.contacts.empty()) return kNoContacts;
  const BiteNumbers numbers(bite);
  const std::string unit = escaped(bite.unit);
  const std::vector<std::string> head{"contact",
                                      "fixed area, mm²",
                                      "moving area, mm²",
                                      "share, %",
                                      "least distance, µm",
                                      "overlap, mm²",
                                      "depth, integrated, mm³",
                                      "centre, " + unit,
                                      "closest point, " + unit};
  const std::string caption = fmt::format("distance at most {}; share {}",
                                          numbers.length(bite.contact), foundation_words(bite));
  HtmlTable both("contacts", "Contacts on both bodies: " + caption, head);
  HtmlTable alone("contacts-on-one", "Contacts on one body alone: " + caption, head);
  const auto area = [&](const BiteBody& body, const std::vector<std::uint32_t>& regions) {
    double sum = 0;
    for (const std::uint32_t k : regions) sum += body.surface.regions[k].area;
    return regions.empty() ? "–" : numbers.area(sum);
  };
  for (std::size_t i = 0; i < bite.contacts.size(); ++i) {
    const BiteContact& contact = bite.contacts[i];
    (contact.on_both() ? both : alone)
        .add({fmt::format("{}", i + 1), area(bite.fixed, contact.fixed),
              area(bite.moving, contact.moving),
              BiteNumbers::share(100 * contact.share, 100 * contact.share_thinner,
                                 100 * contact.share_thicker),
              numbers.micrometres(contact.least_distance), numbers.area(contact.penetrating_area),
              numbers.volume(contact.depth_integral), numbers.place(contact.centre),
              numbers.place(contact.closest)});
  }
  const std::string reading = fmt::format("<p>Shares: {}.</p>\n", kSharesOnOneBody);
  return (both.empty() ? "" : both.html()) + (alone.empty() ? "" : alone.html() + reading);
}

}  // namespace ist::cli
