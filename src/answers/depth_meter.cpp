#include "answers/depth_meter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "ist/base/pose.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"

namespace ist::answers {
namespace {

// Vertices behind an open surface, farther than this part of the extent, are hardly in the body: 2
// of 100 mm.
constexpr double kOpenReach = 0.02;
// Triangles with longer edges, as a part of the extent, are split to measure areas: 2 of 100 mm.
constexpr double kLongestEdge = 0.02;

// Returns the place of the deepest vertex in the other body, fixed coordinates, or nothing if no
// vertex lies inside.
std::optional<Eigen::Vector3d> deepest_vertex(const Query& query, const Occlusion& bite,
                                              const Eigen::Isometry3d& pose) {
  std::optional<Eigen::Vector3d> deepest;
  double least = 0;
  const auto look = [&](const SurfaceOcclusion& side, const TriangleMesh& mesh,
                        const Eigen::Isometry3d& to_fixed) {
    for (std::size_t i = 0; i < side.vertices.size(); ++i) {
      if (!(side.vertices[i].distance < least)) continue;  // NaN beyond the reach
      least = side.vertices[i].distance;
      deepest = to_fixed * mesh.vertices[i];
    }
  };
  look(bite.fixed, *query.fixed().triangles(), Eigen::Isometry3d::Identity());
  look(bite.moving, *query.moving().triangles(), pose);
  return deepest;
}

}  // namespace

DepthMeter::DepthMeter(Query& query, const Bodies& bodies, double tolerance)
    : query_(query), tolerance_(tolerance), extent_(bodies.extent()) {
  std::vector<std::string> open;
  bool borders = true;  // every open body has one
  const auto look = [&](const SphereTree& tree, const std::string& name, bool has_border) {
    if (tree.triangles() == nullptr && why_none_.empty()) {
      why_none_ = fmt::format("{} holds no triangles: build it without --no-triangles", name);
    }
    if (tree.orientation() == Orientation::kOutward) return;
    open.push_back(name);
    borders = borders && has_border;
  };
  look(bodies.fixed, bodies.fixed_name, bodies.fixed_has_border);
  look(bodies.moving, bodies.moving_name, bodies.moving_has_border);
  if (open.empty() || !why_none_.empty()) return;
  why_none_ = fmt::format("{} {} open{}", fmt::join(open, " and "), open.size() == 1 ? "is" : "are",
                          borders ? "" : " or not wound consistently");
}

std::string DepthMeter::why_none(const Depth& depth) const {
  const bool bound = depth.at_vertices.value_or(0) > 0;
  return fmt::format("depth is {}: {}", bound ? "a lower bound, measured at vertices" : "not known",
                     why_none_);
}

double DepthMeter::open_reach() const { return kOpenReach * extent_; }

Depth DepthMeter::at(const Eigen::Isometry3d& pose, bool near, const Budget& budget) const {
  Depth depth;
  if (!query_.has_triangles()) return depth;
  OcclusionOptions areas;
  areas.reach = open_reach();
  areas.limits.clear();
  areas.contact = areas.foundation = areas.change = 0;
  areas.longest_edge = kLongestEdge * extent_;
  if (why_none_.empty()) {
    const Penetration found = penetration(query_, pose, tolerance_, {.budget = budget});
    depth.certain = {found.lower, found.upper};
    depth.complete = found.complete;
    depth.capped = found.capped;
    if (found.upper == 0) {
      depth.at_vertices = depth.area = 0;
      return depth;
    }
    if (found.lower > 0) depth.point = found.point;
    areas.reach = found.upper;
  } else if (!near) {
    return depth;
  }
  const Occlusion bite = occlusion(query_, pose, areas);
  depth.at_vertices = std::max(bite.fixed.depth_at_vertices, bite.moving.depth_at_vertices);
  depth.area = 0.5 * (bite.fixed.penetrating_area + bite.moving.penetrating_area);
  if (!depth.certain) depth.point = deepest_vertex(query_, bite, *project_to_rigid(pose));
  return depth;
}

}  // namespace ist::answers
