#include "ist/query/search_pose.h"

#include <cmath>

namespace ist {
namespace {

// What the kernels err by, in parts of |A| + |B| + |t|, u = 2⁻²⁴. |A| bounds a node's centre plus
// its radius, and by more than a fourth the corners of the root cube.
//   Decoding a centre, parent's cube and offset in it: the factor and the product 2u of each, the
//   sum u; the two are together no longer than the root cube's half diagonal, so 2.6u|A| for
//   blocks, and 4u|A| for the table, which adds three numbers. Turning the fixed one: entries,
//   products and two sums of three, √3 (1 + 1 + 2)u|a|, and adding the translation u(|a| + |t|),
//   itself narrowed, u|t|: 8u|A| + 2u|t|. Difference, squares and their sums: 2.5u of the distance,
//   which is about rA + rB; radii 2u, pad, sum and square 2.5u: 7u (rA + rB).
// |a| + rA <= |A|, so no length is counted for more than 12u.
constexpr double kBallRounding = 12.5 * 0x1p-24;
// In a slab's test the same difference meets a normal that errs by 7u, in a dot product of 5u, less
// an offset, against a sum: 16u (rA + rB) at most. A radius is at most 1.01 √3 half edges of
// the root, and |A| at least 2.21 of them, so rA < 0.8|A|: 2.6u|A| + 8u|a| + 16u rA < 17u|A|.
constexpr double kSlabRounding = 17 * 0x1p-24;

// A reach that is grown lets bounds touch that are so much farther apart, and a test errs by up to
// 16u of that too: more is added than is asked for.
constexpr double kOfGrowth = 1 + 32 * 0x1p-24;

float round_up(double value) noexcept {
  return std::nextafter(static_cast<float>(value), HUGE_VALF);
}

}  // namespace

SearchPose narrow(const RelativePose& pose, double reaches, double grow) noexcept {
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
  const double lengths = reaches + std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2]);
  narrow.ball_pad = round_up(kBallRounding * lengths + kOfGrowth * grow);
  narrow.slab_pad = round_up(kSlabRounding * lengths + kOfGrowth * grow);
  return narrow;
}

SearchPose grown(const SearchPose& pose, double by) noexcept {
  SearchPose grown = pose;
  grown.ball_pad = round_up(pose.ball_pad + kOfGrowth * by);
  grown.slab_pad = round_up(pose.slab_pad + kOfGrowth * by);
  return grown;
}

}  // namespace ist
