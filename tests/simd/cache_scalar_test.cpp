// What the scalar forms of a cache's kernels mean: a cache that was made at one pose with a margin
// gives, at that pose and at others near it, what a search gives there.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "ist/query/pair_cache/motion_bound.h"
#include "ist/query/traversal/search_pose.h"
#include "simd/cache_cases.h"
#include "support/effort.h"

namespace ist::test {
namespace {

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

// A pose at which two bodies of all_plans() are likely to touch.
RelativePose random_relative(Random& random) {
  const Eigen::Matrix3d rotation = random.rotation();
  return {rotation, random.point(-0.7, 0.7)};
}

// A pose that is turned by up to some `by` about some point, and moved by as much.
RelativePose nudged(const RelativePose& pose, double by, Random& random) {
  Eigen::AngleAxisd turn(by * random.uniform(0, 1), random.direction());
  return {turn.toRotationMatrix() * pose.rotation,
          pose.translation + by * random.uniform(0, 1) * random.direction()};
}

class CacheOf {
 public:
  CacheOf(const PlannedSearch& search, const RelativePose& centre, double extent)
      : search_(search), cache_(kRoomy, kRoomy), rows_(kRoomy) {
    const SearchPose pose = to_float(centre, fixed_, moving_, extent);
    const auto in = before_last(search, pose, *scratch_);
    SearchCursor cursor;
    const Advanced made =
        advance_cache_scalar(last(), pose, *in, cursor, cache_, *scratch_, kNoLimit);
    EXPECT_FALSE(made.full);
  }

  // Holds what the cache gives at a pose against what a search gives. Returns the pairs.
  std::size_t check(const RelativePose& at, double margin) {
    const SearchPose pose = to_float(at, fixed_, moving_, margin);
    const auto in = before_last(search_, pose, *scratch_);
    GuardedFrontier out(kRoomy, 0);
    SearchCursor cursor;
    DistanceBounds none;
    const Advanced made = advance_scalar(last(), pose, *in, cursor, out, *scratch_, kNoLimit,
                                         Measured::kNothing, none);
    EXPECT_FALSE(made.full);
    std::vector<LeafPair> expected(out.moving_count), found;
    write_leaf_pairs_scalar(out, expected.data());
    turn_cache_scalar(cache_, last(), pose, true, rows_);
    std::vector<std::uint32_t> places(cache_.pair_count + kCacheSpare);
    places.resize(select_cache_scalar(cache_, last(), rows_, 0, cache_.pair_count, places.data()));
    for (const std::uint32_t place : places) {
      found.push_back({cache_.fixed.id[cache_.moving.row[place]], cache_.moving.id[place]});
    }
    EXPECT_EQ(found, expected);
    check_contacts(pose, *in, places.size());
    return found.size();
  }
  [[nodiscard]] const CacheLanes& lanes() const { return cache_; }

 private:
  void check_contacts(const SearchPose& pose, const Frontier& in, std::size_t pairs) {
    TermsRecorder wanted_terms, terms;
    ContactAdder& wanted = *wanted_;
    ContactAdder& made = *made_;
    wanted.clear();
    made.clear();
    wanted.rule = made.rule = rule_of(search_, 0.25);
    wanted.stream = &wanted_terms;
    made.stream = &terms;
    SearchCursor cursor;
    DistanceBounds none;
    advance_contacts_scalar(last(), pose, in, cursor, wanted, *scratch_, kNoLimit,
                            Measured::kNothing, none);
    add_contacts_scalar(last(), pose, wanted);
    add_cache_scalar(cache_, last(), rows_, 0, cache_.pair_count, made);
    EXPECT_TRUE(same(made.totals, wanted.totals));
    EXPECT_EQ(made.totals.pairs, pairs);
    EXPECT_TRUE(terms.is(wanted_terms.with_weight()));
  }
  [[nodiscard]] const SearchStep& last() const { return search_.plan.steps().back(); }

  const PlannedSearch& search_;
  const TreeLengths fixed_ = lengths_of(search_.fixed, search_.policy),
                    moving_ = lengths_of(search_.moving, search_.policy);
  GuardedCache cache_;
  GuardedRows rows_;
  const std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
  const std::unique_ptr<ContactAdder> wanted_ = std::make_unique<ContactAdder>(),
                                      made_ = std::make_unique<ContactAdder>();
};

TEST(CacheScalar, GivesWhatASearchGivesAtEveryPoseWithinTheSlack) {
  Random random(2);
  std::size_t found = 0, others = 0;
  int poses = 0;
  for (const auto& search : all_plans()) {
    SCOPED_TRACE(std::string(to_string(search->policy)));
    const MotionBound bound(search->fixed, search->moving, search->policy);
    const TreeLengths fixed = lengths_of(search->fixed, search->policy),
                      moving = lengths_of(search->moving, search->policy);
    const double voxel = std::min(search->fixed.voxel_size(), search->moving.voxel_size());
    for (int round = 0; round < 3; ++round) {
      const RelativePose centre = random_relative(random);
      const double margin = round == 0 ? 0 : voxel * random.uniform(0, 1);
      const double extent = most_apart(centre, fixed, moving, margin) * (1 + 1e-6) +
                            0.5 * voxel * random.uniform(0, 1);
      CacheOf cache(*search, centre, extent);
      found += cache.check(centre, margin);
      // Poses within the slack alone.
      for (int k = 0; k < samples(12); ++k) {
        const RelativePose at = nudged(centre, voxel * random.uniform(0, 0.5), random);
        const double need = most_apart(at, fixed, moving, margin);
        if (!(need + bound.between(centre, at, extent) <= extent)) continue;
        ++poses;
        const std::size_t pairs = cache.check(at, margin);
        others += cache.lanes().pair_count - pairs;
        found += pairs;
      }
      if (::testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(found, samples(std::size_t{25'000}));
  EXPECT_GT(others, samples(std::size_t{5'000}));  // pairs that the cache holds besides
  EXPECT_GT(poses, samples(100));
}

}  // namespace
}  // namespace ist::test
