#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/contact.h"
#include "ist/query/contact_sink.h"
#include "ist/query/exact/pair_set.h"
#include "ist/query/exact/triangles_meet.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// From pairs of leaves to the pairs of triangles in them that meet, or to the nearest. Each pair
/// of triangles is tested once, however many leaves it is in; a pair that meets has a point in
/// common, which lies in a leaf of either tree, and these two leaves' geometry meets: so none is
/// missed.
///
/// A moving vertex v is where the pose, projected to a rigid motion, puts it: in double,
/// ((r₀₀ v₀ + r₀₁ v₁) + r₀₂ v₂) + t₀ and so on, with no product fused to a sum. The test is exact
/// for these doubles.
///
/// Memory is bounded: where more pairs of triangles are near each other than it holds, a part of
/// them is looked at in each of several passes over the leaves.
class TrianglePairs final : public ContactStream {
 public:
  /// Both trees must have triangles. Memory: 28 bytes a moving vertex, 8 a moving triangle, and 20
  /// to 36 for each of `candidates`, the pairs that can be told apart in one pass.
  TrianglePairs(const SphereTree& fixed, const SphereTree& moving, std::size_t candidates);

  /// Begins a query. `pose` is rigid. Pairs go into `out`, the first of them where it is too short.
  void begin(const Eigen::Isometry3d& pose, std::span<TrianglePair> out) noexcept;
  /// Begins a query that ends with the first pair.
  void begin_any(const Eigen::Isometry3d& pose) noexcept;
  /// Begins one for the nearest pair, of those that are less than `limit` apart; ends where one
  /// meets. One pass is enough.
  void begin_nearest(const Eigen::Isometry3d& pose, double limit) noexcept;

  /// Whether another pass over all pairs of leaves is to be made; the next one begins.
  [[nodiscard]] bool next_pass() noexcept;
  bool take(std::span<const Contact> contacts) noexcept override;

  /// Sorts what is in the span.
  void finish() noexcept;
  /// Pairs that meet, in the span or not.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// How far the nearest pair is apart, or the limit; it may err by `distance_error()`.
  [[nodiscard]] double distance() const noexcept { return nearest_; }
  [[nodiscard]] double distance_error() const noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void begin(const Eigen::Isometry3d& pose) noexcept;
  [[nodiscard]] bool try_pair(std::uint32_t fixed, std::uint32_t moving) noexcept;
  [[nodiscard]] const Eigen::Vector3d& moved(std::uint32_t vertex) noexcept;
  void add(TrianglePair pair) noexcept;
  void measure(const TriangleCorners& a, const TriangleCorners& b) noexcept;

  const LeafTriangles& fixed_;
  const LeafTriangles& moving_;
  PairSet seen_;
  std::vector<Eigen::Vector3d> moved_;   // moving vertices, those that this query has asked for
  std::vector<std::uint32_t> moved_in_;  // the query that asked last
  std::uint32_t query_ = 0;
  std::vector<std::uint32_t> near_;       // moving triangles in the leaves that touch a fixed leaf
  std::vector<std::uint32_t> near_leaf_;  // the fixed leaf that a moving triangle was last near to
  std::uint32_t leaf_ = 0;

  Eigen::Isometry3d pose_;
  std::span<TrianglePair> out_;
  std::uint64_t count_ = 0;
  enum class Wanted : std::uint8_t { kAll, kAny, kNearest } wanted_ = Wanted::kAll;
  double nearest_ = 0;
  double longest_edge_;
  bool full_ = false;
  std::uint64_t passes_ = 1, pass_ = 0;  // a power of two
};

}  // namespace ist
