#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "ist/base/platform/bit_cast.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "simd/triangles/ball_step.h"
#include "simd/triangles/closest.h"

/// The interface of the kernels that look for the triangle nearest to a point, and of those that
/// search two trees of triangle clusters. Lengths are in mesh
/// units, coordinates in the fixed tree's frame, where nothing else is said.
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

/// The rigid motion from the moving tree's frame to the fixed tree's, y = rotation · x +
/// translation, in plain numbers.
struct ClusterPose {
  double rotation[3][3];
  double translation[3];
  double grid;  ///< of the fixed tree's centres
  float error;  ///< of any difference of coordinates, beside the rounding of float
};

/// The bounds of sixteen moving nodes, turned. The centre is centre + rest, where `centre` is a
/// multiple of the fixed grid, so that its distance from a fixed centre is rounded only once.
struct alignas(64) TurnedBlock {
  float centre[3][kClusterWidth], rest[3][kClusterWidth];
  float low[3][kClusterWidth], high[3][kClusterWidth];  ///< of the box, from the centre
  float normal[3][kClusterWidth], offset[kClusterWidth], thickness[kClusterWidth];
  float rim[kClusterWidth], radius[kClusterWidth];
};

/// Pairs of one of sixteen lanes and a fixed node: each is 16 times the node's index and the lane.
struct LaneNodes {
  const std::uint32_t* codes;
  std::size_t count;

  [[nodiscard]] std::uint32_t lane(std::size_t k) const noexcept {
    return codes[k] % kClusterWidth;
  }
  [[nodiscard]] std::uint32_t node(std::size_t k) const noexcept {
    return codes[k] / kClusterWidth;
  }
  [[nodiscard]] LaneNodes part(std::size_t first, std::size_t most) const noexcept {
    const std::size_t rest = count - first;
    return {codes + first, rest < most ? rest : most};
  }
};

/// The bounds of all fixed nodes at a level: node i is lane i % 16 of block i / 16, so that block i
/// holds the children of node i of the level above.
struct FixedNodes {
  const NodeBlock* blocks;
  std::uint32_t count;

  [[nodiscard]] std::uint32_t children_of(std::uint32_t parent) const noexcept {
    const std::uint32_t rest = count - kClusterWidth * parent;
    return rest < kClusterWidth ? rest : kClusterWidth;
  }
  [[nodiscard]] std::uint64_t children_of(const LaneNodes& parents) const noexcept {
    std::uint64_t all = 0;
    for (std::size_t k = 0; k < parents.count; ++k) all += children_of(parents.node(k));
    return all;
  }
};

/// A test of two nodes in float errs by at most this part of their radii and the reach, together.
inline constexpr float kNodeRounding = 0x1p-20F;
/// The most by which rounding lowers the square of a sine.
inline constexpr float kSineRounding = 0x1p-20F;
/// The part of the square of the centres' distance in a score.
inline constexpr float kCentreShare = 0x1p-4F;
/// The rounding error of a determinant of three differences, as a part of the product of their
/// sizes: the sums of their absolute coordinates.
inline constexpr float kDeterminantRounding = 0x1p-20F;
/// More than underflow can take from the square of a gap.
inline constexpr float kSquareUnderflow = 0x1p-140F;
/// More than underflow can take from a determinant, where its rounding is not more.
inline constexpr float kUnderflow = 0x1p-120F;

/// Begins to load all of an item that is read soon.
template <class Item>
inline void load_ahead(const Item& item) noexcept {
  const char* const bytes = reinterpret_cast<const char*>(&item);
  for (std::size_t line = 0; line < sizeof item; line += 64) __builtin_prefetch(bytes + line);
}

/// Turns the bounds of a moving node's children.
using TurnNodesFunction = void (*)(const NodeBlock& moving, const ClusterPose& pose,
                                   TurnedBlock& out);

/// Tests the first `lane_count` lanes against each of some fixed nodes. Writes for each node the
/// lanes within `reach` of which it may be, as bits. (The lanes of `nodes` do not matter.)
using MeetNodesFunction = void (*)(const TurnedBlock& lanes, std::uint32_t lane_count,
                                   const FixedNodes& fixed, LaneNodes nodes, float reach,
                                   std::uint32_t* bits);

/// Lists the pairs that such bits say, by lanes, and of a lane in the order of `nodes`. Returns
/// their number. May read sixteen more nodes and bits, and write sixteen more pairs.
using ListLanesFunction = std::size_t (*)(LaneNodes nodes, const std::uint32_t* bits,
                                          std::uint32_t* out);

/// Tests the lane of each pair against the children of its node. Lists the pairs of a lane and a
/// child that may be within `reach`, in their order, and returns their number. May write sixteen
/// more.
using MeetChildrenFunction = std::size_t (*)(const TurnedBlock& lanes, const FixedNodes& children,
                                             LaneNodes parents, float reach, std::uint32_t* out);

/// Says how near one lane is to each child of a fixed node, smaller being nearer: the square of the
/// distance of the boxes, and a part of that of the centres.
using ScoreChildrenFunction = void (*)(const TurnedBlock& lanes, std::uint32_t lane,
                                       const NodeBlock& children, float* scores);

/// Two triangles by their indices in the meshes.
struct TriangleIds {
  std::uint32_t fixed, moving;

  friend auto operator<=>(const TriangleIds&, const TriangleIds&) = default;
};

/// Candidates: pairs of triangles that no box and no plane tells apart, side by side, in frames of
/// their fixed clusters.
struct alignas(64) TriangleBatch {
  static constexpr std::size_t kSize = 256;
  static constexpr std::size_t kRoom = kSize + kClusterWidth;
  float fixed[3][3][kRoom], moving[3][3][kRoom];  ///< corner, coordinate
  float error[kRoom];                             ///< of any difference of coordinates
  std::uint32_t fixed_id[kRoom], moving_id[kRoom];
  std::size_t count = 0;
  std::uint32_t codes[kClusterWidth * kClusterWidth + kClusterWidth] = {};  ///< for the kernels
};

/// Pairs of triangles that were found, by their indices in the meshes. A kernel may write a vector
/// behind the last one.
struct TriangleList {
  std::uint32_t *fixed, *moving;
  std::size_t count = 0;

  [[nodiscard]] TriangleIds operator[](std::size_t at) const noexcept {
    return {fixed[at], moving[at]};
  }
  void add(TriangleIds ids) noexcept {
    fixed[count] = ids.fixed;
    moving[count++] = ids.moving;
  }
};

/// Pairs that are certain to meet, and pairs that float cannot decide.
struct FoundTriangles {
  /// The most that one pair of clusters adds to a list, with the content of a batch.
  static constexpr std::size_t kMostAtOnce = kClusterWidth * kClusterWidth + TriangleBatch::kRoom;
  /// The room of each list.
  static constexpr std::size_t kRoom = 4 * kMostAtOnce;

  TriangleList certain, open;
  float* squares = nullptr;  ///< beside `open`: of distances that the pairs have at least

  [[nodiscard]] bool has_room() const noexcept {
    return (certain.count > open.count ? certain.count : open.count) <= kRoom - kMostAtOnce;
  }
};

/// The triangles of two trees at a pose.
struct ClusterStep {
  ClusterPose pose;
  FixedNodes fixed_nodes;  ///< the clusters' bounds
  const TriangleCluster *fixed, *moving;
  std::uint32_t fixed_triangles, moving_triangles;
};

/// Pairs of moving clusters, which are lanes, and fixed ones.
struct ClusterPairs {
  const TurnedBlock& lanes;
  std::uint32_t moving;  ///< the cluster that is lane 0
  LaneNodes pairs;
};

/// Finds pairs of triangles that meet, of pairs of clusters. Candidates go to `batch`; where that
/// is full, they are decided, and go to `out`. Ends where `out` has no room for the next pair of
/// clusters. Returns the number of those that were compared.
using MeetClustersFunction = std::size_t (*)(const ClusterStep& step, const ClusterPairs& pairs,
                                             TriangleBatch& batch, FoundTriangles& out);

/// Decides what is left in a batch, and empties it.
using DecideTrianglesFunction = void (*)(TriangleBatch& batch, FoundTriangles& out);

/// How near triangles are looked for.
struct Reach {
  float triangles;
  float margin;  ///< no less than twice the error of a distance in double
};

/// Finds pairs of triangles, of clusters as for MeetClustersFunction, that may be within reach, or
/// that may be within `margin` of the nearest of those that are: all of them go to `out.open`, and
/// some that are not. Lowers reach.triangles to the most that the nearest has, and the margin. Ends
/// and returns as MeetClustersFunction does.
using NearClustersFunction = std::size_t (*)(const ClusterStep& step, const ClusterPairs& pairs,
                                             Reach& reach, TriangleBatch& batch,
                                             FoundTriangles& out);

/// The kernels of a search of clusters, for one instruction set. Of triangles, meet_clusters,
/// decide_triangles, near_clusters and near_triangles say no more than is certain, and that may
/// differ; all else is the same on all, bit by bit.
struct ClusterKernels {
  TurnNodesFunction turn_nodes;
  MeetNodesFunction meet_nodes;
  ListLanesFunction list_lanes;
  MeetChildrenFunction meet_children;
  ScoreChildrenFunction score_children;
  MeetClustersFunction meet_clusters;
  DecideTrianglesFunction decide_triangles;
  NearClustersFunction near_clusters;
  NearNodesFunction near_nodes;
  NearTrianglesFunction near_triangles;
  ClosestOctetFunction closest_octet;
  BoundNodesFunction bound_nodes;
  BoundCornersFunction bound_corners;
  BoundAroundFunction bound_around;
};

/// The kernels without vectors: they specify the others. Cost: 0.3 µs a test of a node against
/// sixteen.
extern const ClusterKernels kScalarClusterKernels;

namespace simd {

/// Returns the kernels for one of Highway's targets, by its bit.
[[nodiscard]] ClusterKernels cluster_kernels(std::int64_t target);

}  // namespace simd
}  // namespace ist
