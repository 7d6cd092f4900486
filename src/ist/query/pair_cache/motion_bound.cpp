#include "ist/query/pair_cache/motion_bound.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/tree/tree_parts.h"

namespace ist {

MotionBound::MotionBound(const SphereTree& fixed, const Box& of_fixed, const SphereTree& moving,
                         const Box& of_moving, SpherePolicy policy) noexcept
    : fixed_(of_fixed),
      moving_(of_moving),
      leaves_(fixed.largest_leaf_radius(policy) + moving.largest_leaf_radius(policy)),
      lengths_(fixed.bounding_radius() + moving.bounding_radius()) {}

MotionBound::Box MotionBound::box_of(const SphereTree& tree) {
  // The cubes of the leaves' parents hold those of the leaves, in which the centres of bounds lie.
  const LinearOctree& octree = voxels_of(tree).octree;
  // The build's pad and the rounding of a bound.
  const double pad = 1e-6 * tree.voxel_size() + 0x1p-22 * tree.bounding_radius();
  Eigen::Vector3d low, high;
  if (tree.depth() == 0) {
    high.setConstant(0.5 * tree.voxel_size() + pad);
    return {Eigen::Vector3d::Zero(), high};
  }
  low.setConstant(HUGE_VAL);
  high.setConstant(-HUGE_VAL);
  const std::span<const OctreeNode> nodes = octree.nodes(1);
  for (const OctreeNode& node : nodes.first(nodes.size() - 1)) {  // without the sentinel
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double centre = tree.voxel_size() * static_cast<double>(node.centre[i]);
      low[i] = std::min(low[i], centre - tree.voxel_size());
      high[i] = std::max(high[i], centre + tree.voxel_size());
    }
  }
  return {0.5 * (low + high), (0.5 * (high - low)).array() + pad};
}

double MotionBound::between(const RelativePose& from, const RelativePose& to,
                            double reach) const noexcept {
  const Eigen::Vector3d centre = moved(to, moving_.centre);
  const double around = reach + leaves_;
  Eigen::Vector3d middle, half;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double moving = (std::abs(to.rotation(i, 0)) * moving_.half[0] +
                           std::abs(to.rotation(i, 1)) * moving_.half[1]) +
                          std::abs(to.rotation(i, 2)) * moving_.half[2];
    const double low = std::max(fixed_.centre[i] - fixed_.half[i], centre[i] - moving) - around;
    const double high = std::min(fixed_.centre[i] + fixed_.half[i], centre[i] + moving) + around;
    if (low > high) return 0;  // no two leaves are that near
    middle[i] = 0.5 * (low + high);
    half[i] = 0.5 * (high - low);
  }
  // A point at y, at the end, was at from · to⁻¹ · y: away by turn · y + shift.
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      turn(i, j) =
          ((from.rotation(i, 0) * to.rotation(j, 0) + from.rotation(i, 1) * to.rotation(j, 1)) +
           from.rotation(i, 2) * to.rotation(j, 2)) -
          (i == j ? 1 : 0);
    }
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double turned_to = (turn(i, 0) * to.translation[0] + turn(i, 1) * to.translation[1]) +
                             turn(i, 2) * to.translation[2];
    shift[i] = ((turn(i, 0) * middle[0] + turn(i, 1) * middle[1]) + turn(i, 2) * middle[2]) +
               ((from.translation[i] - to.translation[i]) - turned_to);
  }
  // The length of an affine displacement is largest in a corner; four are opposite to the others.
  double largest = 0;
  for (const double sy : {-1.0, 1.0}) {
    for (const double sz : {-1.0, 1.0}) {
      double minus = 0, plus = 0;
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double side = sy * half[1] * turn(i, 1) + sz * half[2] * turn(i, 2);
        const double along = half[0] * turn(i, 0);
        const double a = shift[i] + (side + along), b = shift[i] + (side - along);
        plus += a * a;
        minus += b * b;
      }
      largest = std::max({largest, plus, minus});
    }
  }
  const double rounding = 0x1p-46 * (lengths_ + (sum_in_order(from.translation.cwiseAbs()) +
                                                 sum_in_order(to.translation.cwiseAbs())));
  return std::sqrt(largest) * (1 + 0x1p-40) + rounding;
}

}  // namespace ist
