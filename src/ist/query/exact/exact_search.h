#pragma once

#include <vector>

#include "ist/query/exact/triangle_pairs.h"
#include "ist/query/traversal/search.h"

namespace ist {

/// Answers queries about the triangles of two trees: a traversal down to nodes about as large as
/// triangles, and TrianglePairs there. Works in the calling thread alone.
class ExactSearch {
 public:
  /// Reserves all memory. Both trees must have triangles and `policy`. Holds references to both.
  ExactSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
              const Kernels& kernels, std::size_t triangle_pairs);

  /// Finds all pairs of triangles that intersect; the first go into `out`. `from` is `rigid`,
  /// narrowed. Returns their number.
  [[nodiscard]] std::uint64_t pairs(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                    std::span<TrianglePair> out) noexcept;

  /// Tests whether any pair of triangles intersects.
  [[nodiscard]] bool any(const Eigen::Isometry3d& rigid, const SearchPose& from) noexcept;

  /// Bounds the distance between the surfaces by an interval no wider than `tolerance` and the
  /// error of a distance of two triangles. Pairs farther apart than `limit` are not searched.
  ///
  /// @param pad rounding error of tests with `from`, mesh units
  [[nodiscard]] DistanceInterval nearest(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                         double pad, double limit, double tolerance) noexcept;

  /// Returns the pairs of nodes tested since the query began.
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  const Kernels& kernels_;
  TrianglePairs triangles_;
  SearchPlan plan_;
  Search search_;
  std::vector<LeafPair> window_;  // pairs of nodes pass through it
  std::uint64_t tests_ = 0;
};

}  // namespace ist
