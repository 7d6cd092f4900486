#include "ist/query/traversal/search_pose.h"

#include <cmath>

#include "ist/tree/lookup_table.h"
#include "ist/tree/nested_bounds.h"

namespace ist {
namespace {

// Pads that bound the rounding error of the kernels, in parts of |A| + |B| + |t|, u = 2⁻²⁴: of a
// test of leaves, and of a test of nodes above leaves whose test erred, pad and all
// (docs/guarantees.md, Search pose in float).
constexpr double kUnit = 0x1p-24;
constexpr double kLeafBall = 12.5 * kUnit, kLeafSlab = 17 * kUnit;
constexpr double kInnerBall = 37.5 * kUnit, kInnerSlab = 53 * kUnit;

// A margin enlarges distances, and so the error of a test, by up to 16u of it: more is added than
// asked for.
constexpr double kLeafMargin = 1 + 32 * kUnit, kInnerMargin = 1 + 96 * kUnit;

// |A| + |B| + |t|.
double lengths_between(const RelativePose& pose, const TreeLengths& fixed,
                       const TreeLengths& moving) noexcept {
  const Eigen::Vector3d& t = pose.translation;
  return (fixed.bounding_radius + moving.bounding_radius) +
         std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2]);
}

float round_up(double value) noexcept {
  return std::nextafter(static_cast<float>(value), HUGE_VALF);
}

}  // namespace

TreeLengths lengths_of(const SphereTree& tree, SpherePolicy policy) noexcept {
  return {tree.bounding_radius(), tree.voxel_size(), tree.largest_leaf_radius(policy)};
}

double most_apart(const RelativePose& pose, const TreeLengths& fixed, const TreeLengths& moving,
                  double margin) noexcept {
  return 2 * kLeafSlab * lengths_between(pose, fixed, moving) + kInnerMargin * margin;
}

SearchPose to_float(const RelativePose& pose, const TreeLengths& fixed, const TreeLengths& moving,
                    double margin) noexcept {
  SearchPose narrow{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    double moved = 0;
    for (Eigen::Index j = 0; j < 3; ++j) {
      narrow.rotation[3 * i + j] = static_cast<float>(pose.rotation(j, i));
      moved -= pose.rotation(j, i) * pose.translation[j];
    }
    narrow.translation[i] = static_cast<float>(moved);
  }
  const double lengths = lengths_between(pose, fixed, moving);
  const float leaf_slab = round_up(kLeafSlab * lengths + kLeafMargin * margin);
  narrow.leaf = {round_up(kLeafBall * lengths + kLeafMargin * margin), leaf_slab, leaf_slab};
  const double apart = most_apart(pose, fixed, moving, margin);
  const auto inner_slab = [&](const TreeLengths& tree, const TreeLengths& partner) {
    const double rise = slab_rise(tree.voxel_size, partner.largest_leaf + apart);
    return round_up(kInnerSlab * lengths + kInnerMargin * (margin + rise));
  };
  narrow.inner = {round_up(kInnerBall * lengths + kInnerMargin * margin), inner_slab(fixed, moving),
                  inner_slab(moving, fixed)};
  return narrow;
}

SearchPose inflated(const SearchPose& pose, double by) noexcept {
  const auto more = [](const Pads& pads, double ball, double slab) -> Pads {
    return {round_up(pads.ball + ball), round_up(pads.slab_fixed + slab),
            round_up(pads.slab_moving + slab)};
  };
  SearchPose inflated = pose;
  inflated.leaf = more(pose.leaf, kLeafMargin * by, kLeafMargin * by);
  inflated.inner =
      more(pose.inner, kInnerMargin * by, kInnerMargin * (1 + kPartnerRise * kInnerMargin) * by);
  return inflated;
}

double inner_ball_pad(double bounding_radii, double farthest, double margin) noexcept {
  return kInnerBall * bounding_radii + kInnerBall * kSqrt3 * farthest + kInnerMargin * margin;
}

}  // namespace ist
