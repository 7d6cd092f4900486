#pragma once

#include <cstdint>

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
};

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
/// The least square of the sine between two sides by which a triangle has a plane in float; and how
/// many times the point's error the distance from that plane may err by.
inline constexpr float kPlaneSine = 0x1p-10F;
inline constexpr float kPlaneError = 16;

}  // namespace ist
