#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "query/contacts/contact_cases.h"
#include "query/scenes.h"

namespace ist::test {

/// How the answers were found.
struct KeptCounts {
  std::uint64_t ticks = 0, kept = 0, clear = 0, fresh = 0, pairs = 0;

  void add(const KeptCounts& other) {
    ticks += other.ticks;
    kept += other.kept;
    clear += other.clear;
    fresh += other.fresh;
    pairs += other.pairs;
  }
};

/// Keeps all leaf pairs that it is given.
class PairCollector final : public LeafPairStream {
 public:
  bool take(std::span<const LeafPair> some) noexcept override {
    empty_takes += some.empty() ? 1 : 0;
    pairs.insert(pairs.end(), some.begin(), some.end());
    return true;
  }
  std::vector<LeafPair> pairs;
  int empty_takes = 0;
};

/// Fails the test where two results differ in what must not depend on how they were found, or where
/// no distance can lie in the intervals of both.
inline void expect_same_answer(const QueryResult& kept, const QueryResult& fresh) {
  EXPECT_EQ(kept.status, fresh.status);
  EXPECT_EQ(kept.complete, fresh.complete);
  EXPECT_EQ(kept.truncated, fresh.truncated);
  EXPECT_EQ(kept.level, fresh.level);
  EXPECT_EQ(kept.leaf_pairs, fresh.leaf_pairs);
  EXPECT_EQ(kept.resolution, fresh.resolution);
  EXPECT_EQ(kept.pad, fresh.pad);
  for (const QueryResult& result : {kept, fresh}) {
    const DistanceInterval gap = result.distance.value_or(DistanceInterval{0, 0});
    EXPECT_LE(gap.lower, gap.upper);
  }
  if (!kept.distance || !fresh.distance) return;
  EXPECT_LE(kept.distance->lower, fresh.distance->upper);
  EXPECT_GE(kept.distance->upper, fresh.distance->lower);
}

/// A query that keeps a cache, beside one that keeps none.
class KeptAnswers {
 public:
  KeptAnswers(const Scene& scene, const QueryOptions& options)
      : kept_(std::make_unique<Query>(scene.fixed, scene.moving, options)),
        fresh_(scene.fixed, scene.moving, without_cache(options)) {
    for (const double reach : {0.0, 0.375, 1.0}) {
      for (const std::size_t points : {0u, 32u}) {
        const ManifoldOptions manifold{.points = points, .margin = 2, .reach = reach};
        for (auto* of : {&manifolds_, &others_}) {
          of->emplace_back(scene.fixed, scene.moving, *options.policy, manifold);
        }
      }
    }
  }

  /// Goes on with another verb, or another manifold.
  void choose(Random& random) {
    verb_ = random.below(4);
    manifold_ = random.below(manifolds_.size());
  }
  /// Asks both and compares. Returns the kept query's result.
  QueryResult check(const Eigen::Isometry3d& pose, Random& random) {
    return verb_ == 0   ? check_span(pose, random)
           : verb_ == 1 ? check_stream(pose)
                        : check_contacts(pose, manifold_);
  }
  QueryResult check_contacts(const Eigen::Isometry3d& pose, std::size_t manifold = 1) {
    const FoundContacts made = find_contacts(*kept_, manifolds_[manifold], pose),
                        wanted = find_contacts(fresh_, others_[manifold], pose);
    EXPECT_TRUE(same(made, wanted));
    return count(made.result, wanted.result);
  }
  /// The span is now and then too short.
  QueryResult check_span(const Eigen::Isometry3d& pose, Random& random) {
    const FoundPairs wanted = ask(fresh_, pose);
    const std::size_t all = wanted.leaf_pairs.size();
    const std::size_t room = random.below(4) == 0 ? random.below(all + 1) : all;
    std::vector<LeafPair> out(room);
    QueryResult expected = wanted.result;
    expected.truncated = room < all;
    const QueryResult made = kept_->leaf_pairs(pose, out);
    EXPECT_TRUE(std::equal(out.begin(), out.end(), wanted.leaf_pairs.begin()));
    return count(made, expected);
  }
  QueryResult check_stream(const Eigen::Isometry3d& pose) {
    PairCollector made, wanted;
    const QueryResult result = kept_->leaf_pairs(pose, made);
    const QueryResult expected = fresh_.leaf_pairs(pose, wanted);
    EXPECT_EQ(made.pairs, wanted.pairs);
    EXPECT_EQ(made.empty_takes, 0);
    return count(result, expected);
  }

  [[nodiscard]] Query& kept() { return *kept_; }
  [[nodiscard]] Query& fresh() { return fresh_; }
  [[nodiscard]] const KeptCounts& counts() const { return counts_; }

 private:
  static QueryOptions without_cache(QueryOptions options) {
    options.front_pairs = 0;
    options.workers = 1;
    options.target = "";
    return options;
  }
  QueryResult count(const QueryResult& made, const QueryResult& wanted) {
    expect_same_answer(made, wanted);
    EXPECT_TRUE(made.complete);
    ++counts_.ticks;
    counts_.pairs += made.leaf_pairs;
    // Roots that are apart are clear for both.
    counts_.kept += made.found == Found::kKept ? 1 : 0;
    counts_.clear += made.found == Found::kClear && wanted.found != Found::kClear ? 1 : 0;
    counts_.fresh += made.found == Found::kFresh ? 1 : 0;
    return made;
  }

  std::unique_ptr<Query> kept_;
  Query fresh_;
  std::vector<ContactManifold> manifolds_, others_;
  std::size_t verb_ = 0, manifold_ = 0;
  KeptCounts counts_;
};

}  // namespace ist::test
