#include "ist/query/exact/exact_search.h"

#include <algorithm>

#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// The most pairs of nodes given on at once, and alive at one level.
constexpr std::size_t kPairs = 1 << 14;
// Batch size, in fixed nodes, of a search that soon ends or narrows by its first results.
constexpr std::size_t kGroups = 8;

// Passes pairs of nodes on, and narrows the search to distances below the nearest found so far.
class Nearer final : public LeafPairStream {
 public:
  Nearer(TrianglePairs& triangles, const SearchPose& plain)
      : triangles_(triangles), plain_(plain), pose_(inflated(plain, triangles.within())) {}

  [[nodiscard]] const SearchPose& pose() const { return pose_; }

  bool take(std::span<const LeafPair> nodes) noexcept override {
    const bool more = triangles_.take(nodes);
    pose_ = inflated(plain_, triangles_.within());
    return more;
  }

 private:
  TrianglePairs& triangles_;
  const SearchPose& plain_;
  SearchPose pose_;
};

}  // namespace

ExactSearch::ExactSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                         const Kernels& kernels, std::size_t triangle_pairs)
    : triangles_(fixed, moving, kernels.find_near, triangle_pairs),
      plan_(fixed, moving, policy, {triangles_.fixed_level(), triangles_.moving_level()}),
      search_(plan_, kernels, kPairs),
      window_(kPairs + kLeafPairSpare) {}

std::uint64_t ExactSearch::pairs(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                 std::span<TrianglePair> out) noexcept {
  triangles_.begin(rigid, out);
  tests_ = 0;
  do {
    LeafPairSink sink(window_, triangles_);
    tests_ += search_.run(from, sink);
  } while (triangles_.next_pass());
  triangles_.finish();
  return triangles_.count();
}

bool ExactSearch::any(const Eigen::Isometry3d& rigid, const SearchPose& from) noexcept {
  triangles_.begin_any(rigid);
  LeafPairSink sink(window_, triangles_);
  tests_ = search_.run_hurried(from, sink, kGroups);
  return triangles_.count() > 0;
}

DistanceInterval ExactSearch::nearest(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                      double pad, double limit, double tolerance) noexcept {
  const Dive near = search_.dive(from);
  tests_ = near.tests;
  triangles_.begin_nearest(rigid, std::min(limit, near.farthest + pad), tolerance);
  const bool more = triangles_.take({near.leaves, near.count});
  Nearer nearer(triangles_, from);
  if (more) {
    LeafPairSink sink(window_, nearer);
    tests_ += search_.run_hurried(nearer.pose(), sink, kGroups);
  }
  const double distance = triangles_.distance(), error = triangles_.distance_error();
  return {distance > 0 ? std::max(0.0, std::min(triangles_.within(), distance) - error) : 0,
          distance + error};
}

std::size_t ExactSearch::bytes() const noexcept {
  return triangles_.bytes() + search_.bytes() + window_.size() * sizeof(LeafPair);
}

}  // namespace ist
