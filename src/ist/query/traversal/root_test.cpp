#include "ist/query/traversal/root_test.h"

#include <algorithm>
#include <limits>

#include "ist/query/query_rules.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

Ball root_ball(const SphereTree& tree, SpherePolicy policy) noexcept {
  return is_implicit(policy)
             ? tree.parts().nested_ball(policy, tree.depth(), 0, Eigen::Vector3d::Zero())
             : tree.parts().saved_ball(tree.depth(), 0, 0);
}

}  // namespace

RootTest test_roots(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const RelativePose& pose, double margin) noexcept {
  const Ball a = root_ball(fixed, policy), b = root_ball(moving, policy);
  const double bounding_radii = fixed.bounding_radius() + moving.bounding_radius();
  const double farthest = pose.translation.cwiseAbs().maxCoeff();
  RootTest test{};
  test.pad = pad_in_double(bounding_radii, farthest) + margin;
  Eigen::Vector3d apart;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double moved = ((pose.rotation(i, 0) * b.centre[0] + pose.rotation(i, 1) * b.centre[1]) +
                          pose.rotation(i, 2) * b.centre[2]) +
                         pose.translation[i];
    apart[i] = a.centre[i] - moved;
  }
  const double radius_sum = (a.radius + b.radius) + test.pad;
  // What the float tests may keep must not end here.
  const double inner_pad = inner_ball_pad(bounding_radii, farthest, margin);
  const double farthest_sum = (a.radius + b.radius) + inner_pad;
  const double squared = (apart[0] * apart[0] + apart[1] * apart[1]) + apart[2] * apart[2];
  // Far apart, one coordinate decides, because the square of the distance overflows.
  test.overlap =
      !(farthest > bounding_radii + inner_pad) && !(squared > farthest_sum * farthest_sum);
  const double largest = apart.cwiseAbs().maxCoeff();
  const double between = largest > 0 ? largest * (apart / largest).norm() : 0;
  constexpr double kLargest = std::numeric_limits<double>::max();
  test.distance = {std::clamp(between - radius_sum, 0.0, kLargest),
                   std::min(between + radius_sum, kLargest)};
  return test;
}

}  // namespace ist
