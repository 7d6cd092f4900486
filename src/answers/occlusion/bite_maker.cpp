#include "answers/occlusion/bite_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "answers/extents.h"
#include "answers/measure_progress.h"
#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/bite_numbers.h"
#include "answers/refusals.h"
#include "answers/version.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"

namespace ist::answers {
namespace {

// Deeper than this, millimetres, a bite's registration is looked at again (Zagreb 2026).
constexpr double kMuchOverlap = 0.1;

// The unit of both, and whether it is assumed of any of them.
struct KnownUnit {
  LengthUnit unit;
  bool assumed;
};
KnownUnit unit_of(const Bodies& bodies, const BiteQuestions& questions) {
  const LengthUnit known = bodies.unit();
  if (known == LengthUnit::kUnknown) {
    const bool told = questions.unit != LengthUnit::kUnknown;
    return {told ? questions.unit : LengthUnit::kMillimetre, !told};
  }
  const bool told = known == bodies.told_unit || known == questions.unit;
  return {known, !told && bodies.fixed.source().unit != bodies.moving.source().unit};
}

// Two jaws in another unit than theirs are metres large, or less than a millimetre.
void require_size(const Bodies& bodies, const Bite& bite) {
  constexpr double kLeast = 1, kLargest = 1000;  // millimetres
  for (const auto& [tree, name, option] :
       {std::tuple(&bodies.fixed, &bodies.fixed_name, "--unit"),
        std::tuple(&bodies.moving, &bodies.moving_name, "--unit-moving")}) {
    const double size = largest_extent(box_of(*tree)) / bite.units_per_mm;
    refuse_if(!(size >= kLeast && size <= kLargest), option,
              "{} would be {} large, and jaws are 1 to 1000 mm: tell its unit", *name,
              BiteNumbers::in_millimetres(size));
  }
}

void require_area(const BiteBody& body, const std::string& name) {
  if (body.surface.total_area > 0) return;
  throw_error(ErrorCode::kMeshExtent,
              "{}: the mesh is flat: no triangle has an area, so nothing can touch it: "
              "write it again from its scan",
              name);
}

OcclusionOptions options_of(const Bite& bite) {
  OcclusionOptions options;
  options.reach = bite.reach;
  options.limits.clear();
  for (const double limit : bite.preset->micrometres) {
    if (limit > 0) options.limits.push_back(limit * bite.units_per_micrometre());
  }
  options.contact = bite.contact;
  options.least_area = 0.01 * bite.units_per_mm * bite.units_per_mm;
  options.longest_edge = 0.2 * bite.units_per_mm;
  options.foundation = bite.foundation;
  options.change = bite.change;
  options.within = bite.region;
  return options;
}

void require_in_region(const Bite& bite, const BiteBody& body, const std::string& name) {
  if (!bite.region || body.surface.total_area > 0) return;
  refuse_if(true, "--region", "no triangle of {} has its centroid in {}: the body lies in {}", name,
            box_words(*bite.region), box_words(body.box()));
}

// Returns the area of each limit of the preset, in its order.
std::vector<double> areas_of(const SurfaceOcclusion& surface, const Preset& preset) {
  std::vector<double> areas;
  auto next = surface.areas.begin();
  for (const double limit : preset.micrometres) {
    areas.push_back(limit > 0 ? *next++ : surface.penetrating_area);
  }
  return areas;
}

void fill(BiteBody& body, const SphereTree& tree, const Bite& bite, const ToothLabels& labels) {
  body.mesh = tree.triangles();
  body.closed = tree.orientation() == Orientation::kOutward;
  body.areas = areas_of(body.surface, *bite.preset);
  body.sides = balance_of(body.surface, *body.mesh, body.to_fixed, bite.sides);
  body.fore_aft = balance_of(body.surface, *body.mesh, body.to_fixed, bite.fore_aft);
  if (labels.empty()) return;
  body.teeth = teeth_of(body.surface, *body.mesh, labels);
  body.region_teeth = region_teeth_of(body.surface, labels);
}

void name(BiteBody& body, const MeshSource& source, const char* anonymous, bool no_names) {
  body.name = no_names || source.name.empty() ? anonymous : source.name;
  if (source.hash != 0) body.hash = fmt::format("{:016x}", source.hash);
}

// The box whose middle parts the sides if nothing else does: the fixed body's, within the region.
Eigen::AlignedBox3d middle_box(const Bite& bite, const SphereTree& fixed) {
  const Eigen::AlignedBox3d body = box_of(fixed);
  if (!bite.region) return body;
  const Eigen::AlignedBox3d within = body.intersection(*bite.region);
  return within.isEmpty() ? body : within;
}

// The deepest vertex of the triangles that count, fixed coordinates; nothing if none is inside.
std::optional<Eigen::Vector3d> deepest_in_region(const Bite& bite) {
  std::optional<Eigen::Vector3d> deepest;
  double least = 0;
  for (const BiteBody* body : {&bite.fixed, &bite.moving}) {
    for (const Triangle& triangle : body->mesh->triangles) {
      const auto corner = [&, body = body](std::size_t i) -> Eigen::Vector3d {
        return body->to_fixed * body->mesh->vertices[triangle[i]];
      };
      if (!bite.region->contains((corner(0) + corner(1) + corner(2)) / 3)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const double distance = body->surface.vertices[triangle[i]].distance;
        if (!(distance < least)) continue;  // NaN beyond the reach
        least = distance;
        deepest = corner(i);
      }
    }
  }
  return deepest;
}

std::vector<std::string> checks_of(const Bite& bite) {
  std::vector<std::string> checks;
  const Depth& depth = bite.findings.depth;
  const double at_vertices =
      std::max(bite.fixed.surface.depth_at_vertices, bite.moving.surface.depth_at_vertices);
  const double deepest = depth.certain ? depth.certain->lower : at_vertices;
  if (deepest > kMuchOverlap * bite.units_per_mm) {
    checks.push_back("overlap above 0.1 mm: check the bite registration");
  }
  if (bite.fixed.hash && bite.fixed.hash == bite.moving.hash) {
    checks.push_back("both files hold one mesh: it is compared with itself");
  }
  if (bite.unit_assumed) checks.push_back(fmt::format("unit: {} (assumed)", bite.unit));
  checks.push_back(fmt::format(
      "sides: {} and {}, divided {}", bite.sides.first, bite.sides.second,
      !bite.sides.assumed ? "as named"
      : bite.region       ? "in the middle of the fixed body's box within the region (assumed)"
                          : "in the middle of the fixed body's box (assumed)"));
  if (bite.fore_aft.assumed != bite.sides.assumed) {
    checks.push_back(fmt::format(
        "{} and {} divided in the middle of the fixed body's box{} (assumed)", bite.fore_aft.first,
        bite.fore_aft.second, bite.region ? " within the region" : ""));
  }
  for (const std::string& note : bite.findings.notes) checks.push_back(note);
  const bool overlaps =
      bite.fixed.surface.penetrating_area > 0 || bite.moving.surface.penetrating_area > 0;
  if (overlaps && bite.findings.meeting() <= Meeting::kMayBeInside) {
    checks.push_back(
        "areas in each other lie behind an open surface, which has no inside: the surfaces are "
        "apart");
  }
  const auto is_empty = [](const BiteBody& body) {
    return std::all_of(body.surface.vertices.begin(), body.surface.vertices.end(),
                       [](const SurfaceDistance& one) { return std::isnan(one.distance); });
  };
  if (is_empty(bite.fixed) && is_empty(bite.moving) && !(deepest > 0)) {
    checks.push_back(fmt::format("the map is empty: nothing lies within the reach of {}",
                                 BiteNumbers(bite).millimetres(bite.reach)));
  }
  return checks;
}

}  // namespace

Bite make_bite(const Bodies& bodies, const BiteSources& sources, const Eigen::Isometry3d& pose,
               const BiteQuestions& questions, Progress& progress) {
  require_triangles(bodies);
  Bite bite;
  bite.made_by = version_words();
  const KnownUnit unit = unit_of(bodies, questions);
  bite.unit_assumed = unit.assumed;
  bite.unit = to_string(unit.unit);
  bite.frame = bodies.frame();
  bite.units_per_mm = 1e-3 / metres_per_unit(unit.unit);
  require_size(bodies, bite);
  bite.pose = *project_to_rigid(pose);
  bite.preset = questions.preset;
  bite.scanner_band = questions.scanner_band;
  bite.numbers = questions.numbers;
  bite.region = questions.region;
  bite.reach = questions.reach * bite.units_per_mm;
  for (double* length : {&bite.contact, &bite.foundation, &bite.change}) {
    *length *= bite.units_per_mm;
  }
  std::tie(bite.sides, bite.fore_aft) =
      divisions(questions.sides, bodies.frame(), middle_box(bite, bodies.fixed));
  bite.moving.to_fixed = bite.pose;
  name(bite.fixed, sources.fixed, "fixed", questions.no_names);
  name(bite.moving, sources.moving, "moving", questions.no_names);

  const auto labels_of = [&](const SphereTree& tree, const std::filesystem::path& file,
                             double factor = 1) {
    return file.empty() ? ToothLabels()
                        : read_labels(file, *tree.triangles(), *bite.numbers, factor);
  };
  const ToothLabels labels_fixed = labels_of(bodies.fixed, questions.labels_fixed);
  const ToothLabels labels_moving =
      labels_of(bodies.moving, questions.labels_moving, bodies.moving_factor);

  OcclusionOptions options = options_of(bite);
  options.proceed = shown_by(progress, "measuring the occlusion");
  const Query query(bodies.fixed, bodies.moving, {.policy = bodies.query_policy()});
  Occlusion measured = occlusion(query, pose, options);
  bite.fixed.surface = std::move(measured.fixed);
  bite.moving.surface = std::move(measured.moving);
  fill(bite.fixed, bodies.fixed, bite, labels_fixed);
  fill(bite.moving, bodies.moving, bite, labels_moving);
  require_in_region(bite, bite.fixed, bodies.fixed_name);
  require_in_region(bite, bite.moving, bodies.moving_name);
  require_area(bite.fixed, bodies.fixed_name);
  require_area(bite.moving, bodies.moving_name);
  bite.findings = Examiner(bodies, {}, {}).at(pose);
  // The same triangles count for all areas.
  bite.findings.depth.area =
      0.5 * (bite.fixed.surface.penetrating_area + bite.moving.surface.penetrating_area);
  if (bite.region || !bite.findings.depth.certain) {
    bite.findings.depth.at_vertices = bite.known_depth(
        std::max(bite.fixed.surface.depth_at_vertices, bite.moving.surface.depth_at_vertices));
  }
  if (bite.region) bite.findings.depth.point = deepest_in_region(bite);
  bite.number_contacts();
  bite.warning = warning_of(bite);
  bite.hint = hint_of(bite);
  bite.checks = checks_of(bite);
  return bite;
}

}  // namespace ist::answers
