#include "ist/measure/far_inside.h"

#include <cmath>
#include <limits>
#include <vector>

#include "ist/base/ordered_vector.h"
#include "ist/measure/distances_of.h"
#include "ist/mesh/components.h"
#include "ist/mesh/weld.h"

namespace ist {

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

}  // namespace ist
