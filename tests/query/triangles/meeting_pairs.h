#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "support/exact.h"
#include "support/rigid_pose.h"

namespace ist::test {

/// All pairs of triangles that meet, sorted, each decided in rational numbers of what is guaranteed
/// to be the moved vertices. Both trees must have triangles. Boxes are swept along x. Cost: some
/// microseconds a triangle, and 0.1 ms a pair of boxes that overlap.
[[nodiscard]] inline std::vector<TrianglePair> meeting_pairs(const SphereTree& fixed,
                                                             const SphereTree& moving,
                                                             const Eigen::Isometry3d& pose) {
  const Eigen::Isometry3d m = rigid_pose(pose);
  const TriangleMesh& a = parts_of(fixed).triangles->mesh;
  TriangleMesh b = parts_of(moving).triangles->mesh;
  for (Eigen::Vector3d& v : b.vertices) {
    const Eigen::Vector3d x = v;
    for (Eigen::Index i = 0; i < 3; ++i) {
      v[i] = ((m(i, 0) * x[0] + m(i, 1) * x[1]) + m(i, 2) * x[2]) + m(i, 3);
    }
  }
  const auto boxes_of = [](const TriangleMesh& mesh) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const Triangle& t : mesh.triangles) {
      auto& box = boxes.emplace_back();
      for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
    }
    return boxes;
  };
  const auto boxes_a = boxes_of(a), boxes_b = boxes_of(b);
  std::vector<std::uint32_t> order(boxes_b.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto left = [&](std::uint32_t j) { return boxes_b[j].min()[0]; };
  std::ranges::sort(order, {}, left);
  double widest = 0;
  for (const auto& box : boxes_b) widest = std::max(widest, box.sizes()[0]);
  std::vector<TrianglePair> pairs;
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    const Eigen::AlignedBox3d& box = boxes_a[i];
    const double from = box.min()[0] - 1.001 * widest;  // for the rounding of a width
    for (auto j = std::ranges::lower_bound(order, from, {}, left);
         j != order.end() && left(*j) <= box.max()[0]; ++j) {
      if (!box.intersects(boxes_b[*j])) continue;
      if (polygons_meet(exact_triangle(a, i), exact_triangle(b, *j))) pairs.push_back({i, *j});
    }
  }
  std::ranges::sort(pairs, {}, [](const TrianglePair& p) { return std::pair(p.fixed, p.moving); });
  return pairs;
}

}  // namespace ist::test
