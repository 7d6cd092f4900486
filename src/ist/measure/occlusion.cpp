#include "ist/measure/occlusion.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/contact_regions.h"
#include "ist/measure/point_search.h"
#include "ist/measure/refined_surface.h"
#include "ist/measure/require.h"
#include "ist/mesh/components.h"
#include "ist/mesh/weld.h"

namespace ist {
namespace {

// Measures those vertices of a surface that lie inside the body and beyond the reach, too. Of
// vertices that hang together by edges shorter than the reach, and are all beyond it, one says
// for all whether they are inside: no way between them meets the body's surface.
//
// Returns false where `proceed` ended it.
//
// @param points    the vertices of the surface, the body's coordinates
// @param distances theirs, within the reach; completed
bool measure_far_inside(const SurfaceInBody& side, std::span<const Eigen::Vector3d> points,
                        double reach, std::span<SurfaceDistance> distances,
                        const Proceed& proceed) {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  const auto is_far = [&](std::uint32_t v) {
    return distances[v].triangle == SurfaceDistance::kNoTriangle;
  };
  DisjointSets sets(points.size());
  std::vector<bool> used(points.size());
  const std::vector<std::uint32_t> first_at = first_at_position(side.surface.triangles()->vertices);
  for (const Triangle& t : side.surface.triangles()->triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      used[a] = true;
      if (!is_far(a) || !is_far(b)) continue;
      const Eigen::Vector3d edge = difference(points[a], points[b]);
      if (dot_in_order(edge, edge) < reach * reach) sets.join(a, b);
    }
  }
  // The first vertex of each set; then all of those sets whose first one is inside.
  std::vector<std::uint32_t> asked, all;
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    if (used[v] && is_far(v)) (sets.find(v) == v ? asked : all).push_back(v);
  }
  const auto measured = [&](const std::vector<std::uint32_t>& of) {
    std::vector<Eigen::Vector3d> at;
    at.reserve(of.size());
    for (const std::uint32_t v : of) at.push_back(points[v]);
    return distances_of(side.body, side.search, at, kEverywhere, proceed);
  };
  const std::vector<SurfaceDistance> first = measured(asked);
  if (first.size() < asked.size()) return false;
  std::vector<bool> inside(points.size());
  for (std::size_t k = 0; k < asked.size(); ++k) {
    inside[asked[k]] = first[k].distance < 0;
    if (inside[asked[k]]) distances[asked[k]] = first[k];
  }
  std::erase_if(all, [&](std::uint32_t v) { return !inside[sets.find(v)]; });
  const std::vector<SurfaceDistance> rest = measured(all);
  for (std::size_t k = 0; k < rest.size(); ++k) distances[all[k]] = rest[k];
  // Of welded vertices only the first is used.
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    if (!used[v] && used[first_at[v]]) distances[v] = distances[first_at[v]];
  }
  return rest.size() == all.size();
}

using Vector = Eigen::Vector3d;

// The part of a surface's time that its vertices take.
constexpr double kVertices = 0.4;

void require(bool fine, const char* name, double value, const char* remedy) {
  if (fine) return;
  throw_error(ErrorCode::kArgumentInvalid, "{}: {} {}", name, value, remedy);
}

void require_options(const OcclusionOptions& options) {
  const auto length = [](const char* name, double value) {
    require(value > 0 && std::isfinite(value), name, value, "is no length: give more than 0");
  };
  const auto amount = [](const char* name, double value) {
    require(value >= 0 && std::isfinite(value), name, value, "is not at least 0, and finite");
  };
  length("reach", options.reach);
  length("longest_edge", options.longest_edge);
  for (const double limit : options.limits) length("limits", limit);
  amount("contact", options.contact);
  amount("least_area", options.least_area);
  amount("foundation", options.foundation);
  amount("change", options.change);
  if (!options.within || !options.within->isEmpty()) return;
  throw Error(ErrorCode::kArgumentInvalid, "within: the box is empty: give two of its corners");
}

double farthest_level(const OcclusionOptions& options) {
  double farthest = std::max(options.contact, options.foundation + options.change);
  for (const double limit : options.limits) farthest = std::max(farthest, limit);
  return farthest;
}

// The triangles whose centroid lies in the box; all if there is no box.
std::vector<std::uint32_t> counted_triangles(const TriangleMesh& mesh,
                                             const std::vector<Vector>& points,
                                             const RigidMove& to_fixed,
                                             const OcclusionOptions& options) {
  std::vector<std::uint32_t> counted;
  counted.reserve(mesh.triangles.size());
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    const Vector middle = scaled(1.0 / 3, sum(sum(points[t[0]], points[t[1]]), points[t[2]]));
    if (!options.within || options.within->contains(to_fixed(middle))) counted.push_back(k);
  }
  return counted;
}

// One surface; its regions are in the body's coordinates yet.
struct MeasuredSurface {
  SurfaceOcclusion surface;
  ContactRegions regions;
};

// Returns nothing where `proceed` ended it.
std::optional<MeasuredSurface> measure_surface(const SurfaceInBody& side, const RigidMove& to_fixed,
                                               const OcclusionOptions& options,
                                               const Proceed& proceed) {
  const TriangleMesh& mesh = *side.surface.triangles();
  std::vector<Vector> points;
  points.reserve(mesh.vertices.size());
  for (const Vector& v : mesh.vertices) points.push_back(side.to_body(v));
  const double near = farthest_level(options);
  const double reach = std::max(options.reach, near + options.longest_edge);
  std::vector<SurfaceDistance> found =
      distances_of(side.body, side.search, points, reach,
                   [&](double part) { return proceed(kVertices * part); });
  if (found.size() < points.size()) return {};
  const Proceed proceed_here = [&](double) { return proceed(kVertices); };
  if (!measure_far_inside(side, points, reach, found, proceed_here)) return {};
  MeasuredSurface out;
  SurfaceOcclusion& surface = out.surface;
  const std::vector<std::uint32_t> counted = counted_triangles(mesh, points, to_fixed, options);
  std::vector<std::uint8_t> counts(points.size(), options.within ? 0 : 1);
  for (const std::uint32_t k : counted) {
    for (const std::uint32_t v : mesh.triangles[k]) counts[v] = 1;
  }
  std::vector<RefinedSurface::Vertex> vertices;
  vertices.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    SurfaceDistance& one = found[v];
    const bool is_far = one.triangle == SurfaceDistance::kNoTriangle;
    vertices.push_back({points[v], is_far ? reach : one.distance, one.triangle});
    if (!is_far && counts[v] != 0) {
      surface.depth_at_vertices = std::max(surface.depth_at_vertices, -one.distance);
    }
    if (is_far || std::abs(one.distance) > options.reach) {
      one = beyond_reach();
    } else {
      one.closest = to_fixed(one.closest);
    }
  }
  surface.vertices = std::move(found);
  const RefinedSurface refined(side, std::move(vertices), counted, near, options.longest_edge,
                               proceed_here);
  if (!refined.complete()) return {};
  surface.areas.assign(options.limits.size(), 0);
  for (const RefinedTriangle& triangle : refined.triangles()) {
    const LevelTriangle corners = refined.corners(triangle);
    for (std::size_t i = 0; i < options.limits.size(); ++i) {
      surface.areas[i] += cut_at(corners, options.limits[i]).area;
    }
    const LevelCut inside = cut_at(corners, 0);
    surface.penetrating_area += inside.area;
    surface.depth_integral += inside.below;
  }
  for (const std::uint32_t k : counted) {
    const Triangle& t = mesh.triangles[k];
    surface.total_area += area_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  out.regions = contact_regions(refined, options);
  for (ContactRegion& region : out.regions.regions) {
    region.centre = to_fixed(region.centre);
    region.closest = to_fixed(region.closest);
  }
  return out;
}

}  // namespace

Occlusion occlusion(const Query& query, const Eigen::Isometry3d& pose,
                    const OcclusionOptions& options) {
  const ScopedFloatEnvironment environment;
  const SphereTree &fixed = query.fixed(), &moving = query.moving();
  require_triangles(fixed, "fixed");
  require_triangles(moving, "moving");
  require_options(options);
  const Eigen::Isometry3d rigid = require_rigid(pose, "pose"), back = inverse_of(rigid);
  const ClusterKernels& kernels = select_kernels(query.target()).clusters;
  const PointSearch in_fixed(fixed, kernels), in_moving(moving, kernels);
  const RigidMove to_fixed(rigid), to_moving(back), stay(Eigen::Isometry3d::Identity());
  const auto goes_on = [&](double part) { return !options.proceed || options.proceed(part); };
  auto of_fixed = measure_surface({fixed, moving, in_moving, to_moving}, to_fixed, options,
                                  [&](double part) { return goes_on(0.5 * part); });
  if (!of_fixed) return {};
  auto of_moving = measure_surface({moving, fixed, in_fixed, to_fixed}, stay, options,
                                   [&](double part) { return goes_on(0.5 + 0.5 * part); });
  if (!of_moving) return {};
  pair_regions(of_fixed->regions, of_moving->regions);
  of_fixed->surface.regions = std::move(of_fixed->regions.regions);
  of_moving->surface.regions = std::move(of_moving->regions.regions);
  return {true, std::move(of_fixed->surface), std::move(of_moving->surface), rotation_error(pose)};
}

}  // namespace ist
