#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/exact/cluster_search.h"
#include "ist/query/exact/pair_list.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"
#include "simd/dispatch.h"

namespace ist {

/// Two bodies at a pose, for exact questions.
struct ExactPose {
  const Eigen::Isometry3d& rigid;  ///< of mesh coordinates
  const RelativePose& relative;    ///< the same, of the trees' frames
};

/// Answers questions about the triangles of two trees: a traversal of their clusters, a decision in
/// float with a bound of its error, and exact arithmetic for what that leaves open. Works in the
/// calling thread alone.
class ExactSearch {
 public:
  /// Reserves all memory. Both trees must have triangles. Holds references to both.
  ExactSearch(const SphereTree& fixed, const SphereTree& moving, const Kernels& kernels);

  /// The end of a search, and its cost.
  struct End {
    bool complete;        ///< not the budget
    std::uint64_t tests;  ///< as ClusterBudget counts them
  };

  /// Finds all pairs of triangles that intersect; the first of them go into `out`. pair_count()
  /// says how many there are.
  End pairs(const ExactPose& pose, const Budget& budget, std::span<TrianglePair> out) noexcept;
  [[nodiscard]] std::uint64_t pair_count() const noexcept { return list_.count(); }

  /// Tests whether any pair of triangles intersects, and sets `found`.
  End any(const ExactPose& pose, const Budget& budget, bool& found) noexcept;

  /// Bounds the distance between the surfaces by an interval that is no wider than `tolerance` and
  /// twice distance_error(), unless the budget ended the search.
  ///
  /// @param distance bounds it already; narrowed
  End nearest(const ExactPose& pose, double tolerance, const Budget& budget,
              DistanceInterval& distance) noexcept;

  /// Returns whether the bodies are so far apart, against their sizes, that float cannot tell their
  /// triangles' distances from each other.
  [[nodiscard]] bool is_too_far(const RelativePose& pose) const noexcept;

  /// Returns the rounding error of a triangle that is moved in double, mesh units.
  [[nodiscard]] double moved_error(const Eigen::Isometry3d& rigid) const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  [[nodiscard]] ClusterPose cluster_pose(const ExactPose& pose) const noexcept;
  void clear_found() noexcept;

  const SphereTree &fixed_, &moving_;
  const TriangleClusters &fixed_clusters_, &moving_clusters_;
  const ClusterKernels& kernels_;
  double largest_coordinate_, longest_edge_;
  ClusterSearch search_;
  PairList list_;
  std::vector<std::uint32_t> ids_;  // what the kernels find
  std::vector<float> squares_;
  FoundTriangles found_{};
  TriangleBatch batch_;
};

}  // namespace ist
