#pragma once

#include <algorithm>
#include <cstdint>

#include "ist/base/platform/bit_cast.h"
#include "ist/mesh/clusters/triangle_clusters.h"

/// The interface of the kernels that look for the triangle that is nearest to a point. Lengths are
/// in mesh units.
namespace ist {

/// A point in a tree's frame, at + rest: `at` is its float, so that little of it is lost.
struct TreePoint {
  float at[3], rest[3];
  float error;  ///< of a sum of coordinates, beside the rounding of float
};

/// A point in a cluster's frame.
struct ClusterPoint {
  float at[3];
  float
      error;  ///< of its distance from any triangle of the cluster, the rounding of float included
  /// A power of two. The kernel multiplies all lengths by it: the fourth power of a length would
  /// underflow or overflow in float at most scales (unit_for).
  float unit = 1;
};

/// Returns a power of two by which a length of `size` becomes 1 to 2, at most 2^63 and at least
/// 2^-63. `size` is not negative.
[[nodiscard]] inline float unit_for(float size) noexcept {
  const std::uint32_t exponent = std::clamp(bit_cast<std::uint32_t>(size) >> 23, 64U, 190U);
  return bit_cast<float>((254 - exponent) << 23);
}

/// Returns, as bits, those of sixteen nodes that may be within sqrt(far) of a point, and writes
/// lower bounds of the squares of their distances. The same on every instruction set, bit by bit.
using NearNodesFunction = std::uint32_t (*)(const NodeBlock& nodes, const TreePoint& point,
                                            float far, float* squares);

/// Returns, as bits, those triangles of a cluster that may be within sqrt(far) of a point and as
/// near as the nearest of them, and writes lower bounds of the squares of their distances, or NaN.
/// Lowers `far` to the most that the nearest one's can be. Other bounds on other instruction sets.
using NearTrianglesFunction = std::uint32_t (*)(const TriangleCluster& cluster,
                                                const ClusterPoint& point, float& far,
                                                float* squares);

/// By how much rounding can make a distance from a node too large, as a part of the coordinates'
/// sizes and the node's radius; and any square, as a part of it.
inline constexpr float kPointRounding = 0x1p-20F;
/// A triangle has a plane in float only if the square of the sine of each corner is more than this:
/// beyond a sharper corner, rounding could take a point for one above the triangle. The distance
/// from the plane errs by at most kPlaneError times the point's error.
inline constexpr float kPlaneSine = 0x1p-10F;
inline constexpr float kPlaneError = 16;

}  // namespace ist
