#include "ist/query/exact/exact_search.h"

#include <algorithm>

#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// The most pairs of nodes given on at once, and alive at one level.
constexpr std::size_t kPairs = 1 << 14;
// Batch size, in fixed nodes, of a search that soon ends or narrows by its first results.
constexpr std::size_t kGroups = 8;

// Passes pairs of nodes on, sooner than PairLister.
struct Hurried : PairLister {
  using PairLister::PairLister;
  static std::size_t most_groups() noexcept { return kGroups; }
};

// Passes pairs of nodes on that are nearer than the nearest triangles so far.
class Nearer : public VisitorBase {
 public:
  Nearer(const SearchPose& plain, const TrianglePairs& triangles, LeafPairSink& sink)
      : plain_(plain), triangles_(triangles), sink_(sink) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    const Advanced made = batch.advance(inflated(plain_, triangles_.within()));
    tests_ += made.tests;
    return made;
  }
  bool leaves(const Frontier& pairs) noexcept {
    sink_.append(pairs);
    return !sink_.stopped();
  }
  static std::size_t most_groups() noexcept { return kGroups; }
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  const SearchPose& plain_;
  const TrianglePairs& triangles_;
  LeafPairSink& sink_;
  std::uint64_t tests_ = 0;
};

}  // namespace

ExactSearch::ExactSearch(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                         const Kernels& kernels, std::size_t triangle_pairs)
    : kernels_(kernels),
      triangles_(fixed, moving, kernels.find_near, triangle_pairs),
      plan_(fixed, moving, policy, {triangles_.fixed_level(), triangles_.moving_level()}),
      search_(plan_, kernels, kPairs),
      window_(kPairs + kLeafPairSpare) {}

std::uint64_t ExactSearch::pairs(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                 std::span<TrianglePair> out) noexcept {
  triangles_.begin(rigid, out);
  tests_ = 0;
  do {
    LeafPairSink sink(plan_, kernels_, window_, triangles_);
    PairLister lister(from, sink);
    search_.run(lister);
    tests_ += lister.tests();
  } while (triangles_.next_pass());
  triangles_.finish();
  return triangles_.count();
}

bool ExactSearch::any(const Eigen::Isometry3d& rigid, const SearchPose& from) noexcept {
  triangles_.begin_any(rigid);
  LeafPairSink sink(plan_, kernels_, window_, triangles_);
  Hurried lister(from, sink);
  search_.run(lister);
  tests_ = lister.tests();
  return triangles_.count() > 0;
}

DistanceInterval ExactSearch::nearest(const Eigen::Isometry3d& rigid, const SearchPose& from,
                                      double pad, double limit, double tolerance) noexcept {
  const Search::Beam near = search_.beam(from);
  triangles_.begin_nearest(rigid, std::min(limit, near.bounds.upper + pad), tolerance);
  LeafPairSink sink(plan_, kernels_, window_, triangles_);
  Nearer nearer(from, triangles_, sink);
  if (nearer.leaves(near.leaves)) search_.run(nearer);
  tests_ = near.tests + nearer.tests();
  const double distance = triangles_.distance(), error = triangles_.distance_error();
  return {distance > 0 ? std::max(0.0, std::min(triangles_.within(), distance) - error) : 0,
          distance + error};
}

std::size_t ExactSearch::bytes() const noexcept {
  return triangles_.bytes() + search_.bytes() + window_.size() * sizeof(LeafPair);
}

}  // namespace ist
