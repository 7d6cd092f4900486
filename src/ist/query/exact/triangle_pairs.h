#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/contact.h"
#include "ist/query/contact_sink.h"
#include "ist/query/exact/node_triangles.h"
#include "ist/query/exact/pair_set.h"
#include "ist/query/exact/triangle_bounds.h"
#include "ist/query/exact/triangles_meet.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// From pairs of nodes, each tree's of the level of its NodeTriangles, to the pairs of triangles in
/// them that meet, or to the nearest. Each pair is tested once, however many nodes it is in; a pair
/// that meets has a point in common, which lies in a node of either tree, and these two nodes'
/// geometry meets: so none is missed.
///
/// A moving vertex v is where the pose, projected to a rigid motion, puts it: in double,
/// ((r₀₀ v₀ + r₀₁ v₁) + r₀₂ v₂) + t₀ and so on, with no product fused to a sum. The test is exact
/// for these doubles.
///
/// Memory is bounded: where more pairs are near each other than it holds, a part of them is looked
/// at in each of several passes over the nodes.
class TrianglePairs final : public ContactStream {
 public:
  /// Both trees must have triangles. Memory: 200 bytes a fixed triangle, 300 a moving one, and 20
  /// to 36 for each of `candidates`, the pairs that can be told apart in one pass.
  TrianglePairs(const SphereTree& fixed, const SphereTree& moving, FindNearFunction find_near,
                std::size_t candidates);

  /// The levels of the nodes that are taken.
  [[nodiscard]] int fixed_level() const noexcept { return fixed_.level(); }
  [[nodiscard]] int moving_level() const noexcept { return moving_.level(); }

  /// Begins a query. `pose` is rigid. Pairs go into `out`, the first of them where it is too short.
  void begin(const Eigen::Isometry3d& pose, std::span<TrianglePair> out) noexcept;
  /// Begins a query that ends with the first pair.
  void begin_any(const Eigen::Isometry3d& pose) noexcept;
  /// Begins one for the nearest pair, or another that is farther by no more than `tolerance`, of
  /// those that are less than `limit` apart; ends where one meets. One pass is enough.
  void begin_nearest(const Eigen::Isometry3d& pose, double limit, double tolerance) noexcept;

  /// Whether another pass over all pairs of nodes is to be made; the next one begins.
  [[nodiscard]] bool next_pass() noexcept;
  bool take(std::span<const Contact> contacts) noexcept override;

  /// Sorts what is in the span.
  void finish() noexcept;
  /// Pairs that meet, in the span or not.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// How far the nearest pair is apart, or the limit; it may err by `distance_error()`.
  [[nodiscard]] double distance() const noexcept { return nearest_; }
  [[nodiscard]] double distance_error() const noexcept;
  /// A pair that is no nearer than that need not be looked at.
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
  Eigen::Vector3d origin_;                    // of bounds, fixed mesh coordinates
  std::vector<TriangleBounds> fixed_bounds_;  // of its triangles
  PairSet seen_;
  // Moving triangles in the order in which the query asked for them, where the pose puts them.
  std::vector<TriangleCorners> moved_corners_;
  std::vector<TriangleBounds> moved_bounds_;
  std::vector<std::uint32_t> moved_;  // which those are
  std::uint32_t moved_count_ = 0;
  // For each moving triangle the turn, of one fixed node, at which it was last looked at, and its
  // place in the above if that was in this query.
  struct Seen {
    std::uint32_t turn = 0, place = 0;
  };
  std::vector<Seen> last_seen_;
  std::uint32_t turn_ = 0, first_turn_ = 0;
  // Of triangles in the moving nodes that touch a fixed node, those that reach into its cube.
  std::vector<std::uint32_t> near_;
  std::size_t near_count_ = 0;
  TriangleLanes lanes_;
  std::vector<NearPair> found_;

  // Not an Isometry3d, whose place in memory depends on the instruction set.
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
