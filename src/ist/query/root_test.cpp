#include "ist/query/root_test.h"

#include <algorithm>
#include <limits>

#include "ist/query/query_rules.h"

namespace ist {
namespace {

Ball root_ball(const SphereTree& tree, SpherePolicy policy) noexcept {
  return is_implicit(policy) ? tree.ball(policy, tree.depth(), 0, Eigen::Vector3d::Zero())
                             : tree.saved_ball(tree.depth(), 0, 0);
}

}  // namespace

RootTest test_roots(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const RelativePose& pose, double grow) noexcept {
  const Ball a = root_ball(fixed, policy), b = root_ball(moving, policy);
  const double reaches = fixed.reach() + moving.reach();
  const double farthest = pose.translation.cwiseAbs().maxCoeff();
  RootTest test{};
  test.slack = slack_in_double(reaches, farthest) + grow;
  Eigen::Vector3d apart;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double moved = ((pose.rotation(i, 0) * b.centre[0] + pose.rotation(i, 1) * b.centre[1]) +
                          pose.rotation(i, 2) * b.centre[2]) +
                         pose.translation[i];
    apart[i] = a.centre[i] - moved;
  }
  const double reach = (a.radius + b.radius) + test.slack;
  const double squared = (apart[0] * apart[0] + apart[1] * apart[1]) + apart[2] * apart[2];
  // Decided by one coordinate where they are far apart, because the square of a distance overflows.
  test.touch = !(farthest > reaches + test.slack) && !(squared > reach * reach);
  const double largest = apart.cwiseAbs().maxCoeff();
  const double distance = largest > 0 ? largest * (apart / largest).norm() : 0;
  constexpr double kLargest = std::numeric_limits<double>::max();
  test.gap = {std::clamp(distance - reach, 0.0, kLargest), std::min(distance + reach, kLargest)};
  return test;
}

}  // namespace ist
