#include "ist/query/traversal/root_test.h"

#include <algorithm>
#include <limits>

#include "ist/base/ordered_vector.h"
#include "ist/query/query_rules.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// Returns the ball round all leaves, or without voxels round all triangles.
Ball root_ball(const SphereTree& tree, SpherePolicy policy) noexcept {
  if (!tree.has_voxels()) return {Eigen::Vector3d::Zero(), tree.bounding_radius()};
  return is_implicit(policy)
             ? voxels_of(tree).nested_ball(policy, tree.depth(), 0, Eigen::Vector3d::Zero())
             : voxels_of(tree).saved_ball(tree.depth(), 0, 0);
}

}  // namespace

RootTest test_roots(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const RelativePose& pose, double margin) noexcept {
  const Ball a = root_ball(fixed, policy);
  Ball b = root_ball(moving, policy);
  b.centre = moved(pose, b.centre);
  const double bounding_radii = fixed.bounding_radius() + moving.bounding_radius();
  const double farthest = pose.translation.cwiseAbs().maxCoeff();
  RootTest test{};
  test.pad = pad_in_double(bounding_radii, farthest);
  // What the float tests may keep must not end here.
  const double inner_pad = inner_ball_pad(bounding_radii, farthest, margin);
  // Far apart, one coordinate decides, because the square of the distance overflows.
  test.overlap = !(farthest > bounding_radii + inner_pad) && !may_touch(a, b, inner_pad);
  const Eigen::Vector3d apart = difference(b.centre, a.centre);
  const double radius_sum = (a.radius + b.radius) + test.pad;
  const double largest = apart.cwiseAbs().maxCoeff();
  const double between = largest > 0 ? largest * length_in_order(apart / largest) : 0;
  constexpr double kLargest = std::numeric_limits<double>::max();
  test.distance = {std::clamp(between - radius_sum, 0.0, kLargest),
                   std::min(between + radius_sum, kLargest)};
  return test;
}

}  // namespace ist
