#include "ist/query/traversal/search_pose.h"

#include <cmath>

namespace ist {
namespace {

// Pads that bound the rounding error of the kernels, in parts of |A| + |B| + |t|, u = 2⁻²⁴
// (docs/guarantees.md, Search pose in float).
constexpr double kBallRounding = 12.5 * 0x1p-24;
constexpr double kSlabRounding = 17 * 0x1p-24;

// A margin enlarges distances, and so the error of a test, by up to 16u of it: more is added than
// asked for.
constexpr double kMarginRounding = 1 + 32 * 0x1p-24;

float round_up(double value) noexcept {
  return std::nextafter(static_cast<float>(value), HUGE_VALF);
}

}  // namespace

SearchPose to_float(const RelativePose& pose, double bounding_radii, double margin) noexcept {
  SearchPose narrow{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    double moved = 0;
    for (Eigen::Index j = 0; j < 3; ++j) {
      narrow.rotation[3 * i + j] = static_cast<float>(pose.rotation(j, i));
      moved -= pose.rotation(j, i) * pose.translation[j];
    }
    narrow.translation[i] = static_cast<float>(moved);
  }
  const Eigen::Vector3d& t = pose.translation;
  const double lengths = bounding_radii + std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2]);
  narrow.ball_pad = round_up(kBallRounding * lengths + kMarginRounding * margin);
  narrow.slab_pad = round_up(kSlabRounding * lengths + kMarginRounding * margin);
  return narrow;
}

SearchPose inflated(const SearchPose& pose, double by) noexcept {
  SearchPose inflated = pose;
  inflated.ball_pad = round_up(pose.ball_pad + kMarginRounding * by);
  inflated.slab_pad = round_up(pose.slab_pad + kMarginRounding * by);
  return inflated;
}

}  // namespace ist
