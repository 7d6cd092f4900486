#pragma once

#include <vector>

#include "ist/query/dive.h"
#include "ist/query/exact/triangle_pairs.h"
#include "ist/query/search.h"

namespace ist {

/// What is asked about the triangles of two trees: a search down to nodes about as large as
/// triangles, and TrianglePairs there. Works in the calling thread alone.
class ExactSearch {
 public:
  /// Both trees must have triangles and `policy`. Holds references to both.
  ExactSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
              const Kernels& kernels, std::size_t triangle_pairs);

  /// All pairs that meet; the first of them into `out`. `rigid` is the pose that `from` is narrowed
  /// from. Returns how many there are.
  [[nodiscard]] std::uint64_t pairs(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                    std::span<TrianglePair> out) noexcept;

  /// Whether a pair meets.
  [[nodiscard]] bool any(const Eigen::Isometry3d& rigid, const SearchPose& from) noexcept;

  /// What is known of the distance: it is in the interval, which is no wider than `tolerance`, but
  /// for what the distance of two triangles may err by. What is farther than `limit` is not looked
  /// for.
  ///
  /// @param pad what `from` may err by
  [[nodiscard]] GapInterval nearest(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                    double pad, double limit, double tolerance) noexcept;

  /// Pairs of nodes tested since the query began.
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  TrianglePairs triangles_;
  SearchPlan plan_;
  Search search_;
  std::vector<Contact> window_;  // pairs of nodes pass through it
  std::uint64_t tests_ = 0;
};

}  // namespace ist
