#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/exact/node_triangles.h"
#include "ist/query/exact/pair_set.h"
#include "ist/query/exact/triangle_bounds.h"
#include "ist/query/exact/triangles_meet.h"
#include "ist/query/results.h"
#include "ist/query/traversal/leaf_pair_sink.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Finds, from pairs of nodes at the levels of NodeTriangles, the pairs of triangles that
/// intersect, or the nearest pair. Each pair is tested once, however many nodes it lies in. A pair
/// that intersects has a point in common, which lies in a node of either tree; the geometry of
/// these two nodes meets, so no pair is missed.
///
/// The pose, projected to a rigid motion, moves a vertex v in double: ((r₀₀ v₀ + r₀₁ v₁) + r₀₂ v₂)
/// + t₀ and so on, with no product fused to a sum. The test is exact for these doubles.
///
/// Memory is bounded: with more near pairs than fit, each of several passes over the nodes tests a
/// part of them.
class TrianglePairs final : public LeafPairStream {
 public:
  /// Reserves all memory: 200 bytes a fixed triangle, 300 a moving one, and 20 to 36 for each of
  /// `candidates`, the pairs that one pass remembers. Both trees must have triangles.
  TrianglePairs(const SphereTree& fixed, const SphereTree& moving, FindNearFunction find_near,
                std::size_t candidates);

  /// Returns the levels of the nodes in take().
  [[nodiscard]] int fixed_level() const noexcept { return fixed_.level(); }
  [[nodiscard]] int moving_level() const noexcept { return moving_.level(); }

  /// Begins a query for all pairs. `pose` is rigid. `out` takes the pairs; where it is too short,
  /// the first of them.
  void begin(const Eigen::Isometry3d& pose, std::span<TrianglePair> out) noexcept;
  /// Begins a query that ends with the first pair.
  void begin_any(const Eigen::Isometry3d& pose) noexcept;
  /// Begins a query for the nearest pair, or one farther by at most `tolerance`, of those less than
  /// `limit` apart; it ends at a pair that intersects. One pass is enough.
  void begin_nearest(const Eigen::Isometry3d& pose, double limit, double tolerance) noexcept;

  /// Begins the next pass over all pairs of nodes. Returns false where none is needed.
  [[nodiscard]] bool next_pass() noexcept;
  bool take(std::span<const LeafPair> leaf_pairs) noexcept override;

  /// Sorts the pairs in the span.
  void finish() noexcept;
  /// Returns the number of pairs that intersect, in the span or not.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Returns the distance of the nearest pair, or the limit; it errs by at most distance_error().
  [[nodiscard]] double distance() const noexcept { return nearest_; }
  [[nodiscard]] double distance_error() const noexcept;
  /// Returns the distance from which on pairs need no test.
  [[nodiscard]] double within() const noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void begin(const Eigen::Isometry3d& pose) noexcept;
  [[nodiscard]] bool try_pair(std::uint32_t fixed, std::uint32_t place) noexcept;
  [[nodiscard]] TriangleCorners moved(const TriangleCorners& corners) const noexcept;
  [[nodiscard]] bool remember(std::uint32_t fixed, std::uint32_t moving) noexcept;
  void add(TrianglePair pair) noexcept;
  void measure(const TriangleCorners& a, const TriangleCorners& b) noexcept;

  void next_turn() noexcept;
  void take_moving(std::uint32_t node, const FloatBox& cube, float distance) noexcept;
  [[nodiscard]] bool try_lanes(std::span<const std::uint32_t> fixed, const FloatBox& cube) noexcept;
  [[nodiscard]] float reach() const noexcept;

  NodeTriangles fixed_, moving_;
  FindNearFunction find_near_;
  Eigen::Vector3d origin_;                    // of the bounds, fixed mesh coordinates
  std::vector<TriangleBounds> fixed_bounds_;  // of the fixed triangles
  PairSet seen_;
  // Moving triangles in the order in which the query first used them, at the pose.
  std::vector<TriangleCorners> moved_corners_;
  std::vector<TriangleBounds> moved_bounds_;
  std::vector<std::uint32_t> moved_;  // their numbers
  std::uint32_t moved_count_ = 0;
  // The turn, of one fixed node, in which a moving triangle was last seen, and its place in the
  // vectors above if that was in this query.
  struct Seen {
    std::uint32_t turn = 0, place = 0;
  };
  std::vector<Seen> last_seen_;
  std::uint32_t turn_ = 0, first_turn_ = 0;
  // The places of the triangles in overlapping moving nodes that reach into the fixed node's cube.
  std::vector<std::uint32_t> near_;
  std::size_t near_count_ = 0;
  TriangleLanes lanes_;
  std::vector<NearPair> found_;

  // Not an Isometry3d, whose alignment depends on the instruction set.
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
  std::span<TrianglePair> out_;
  std::uint64_t count_ = 0;
  enum class Wanted : std::uint8_t { kAll, kAny, kNearest } wanted_ = Wanted::kAll;
  double nearest_ = 0, tolerance_ = 0;
  double longest_edge_;
  bool full_ = false;
  std::uint64_t passes_ = 1, pass_ = 0;  // a power of two
};

}  // namespace ist
