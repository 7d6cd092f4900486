#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "ist/query/pair_cache/motion_bound.h"
#include "ist/query/traversal/search_pose.h"
#include "simd/guarded_cache.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/targets.h"
#include "support/effort.h"

namespace ist::test {
namespace {

/// The size of a cache that is large enough for these tests.
inline constexpr std::size_t kRoomy = 1 << 15;

/// The pairs before the last step, from the roots down by the scalar form.
[[nodiscard]] inline std::unique_ptr<GuardedFrontier> before_last(const PlannedSearch& search,
                                                                  const SearchPose& pose,
                                                                  SearchScratch& scratch) {
  auto in = std::make_unique<GuardedFrontier>(1, 0);
  in->append(0, std::vector<std::uint32_t>{0});
  for (std::size_t step = 0; step + 1 < search.plan.steps().size(); ++step) {
    auto out = std::make_unique<GuardedFrontier>(search.plan.most_pairs(step), 0);
    SearchCursor cursor;
    DistanceBounds none;
    advance_scalar(search.plan.steps()[step], pose, *in, cursor, *out, scratch, ~std::uint64_t{0},
                   Measured::kNothing, none);
    in = std::move(out);
  }
  return in;
}

// The kernels of a cache of leaf pairs: each vector form against the scalar one, which specifies
// it.

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

class CacheKernels : public ::testing::TestWithParam<std::string> {
 protected:
  // Both go through a last step in calls of at most `most` tests, until all is tested or the cache
  // is full. Returns whether it was.
  bool advance_both(const SearchStep& step, const SearchPose& pose, const Frontier& in,
                    GuardedCache& wanted, GuardedCache& made, std::uint64_t most) {
    wanted.row_count = wanted.pair_count = made.row_count = made.pair_count = 0;
    SearchCursor wanted_cursor, cursor;
    Advanced last{};
    do {
      const Advanced expected =
          advance_cache_scalar(step, pose, in, wanted_cursor, wanted, *scratch_, most);
      last = kernels_.advance_cache(step, pose, in, cursor, made, *scratch_, most);
      EXPECT_EQ(last.tests, expected.tests);
      EXPECT_EQ(last.full, expected.full);
      EXPECT_LE(last.tests, most);
      EXPECT_EQ(cursor, wanted_cursor);
    } while (!HasFailure() && last.tests > 0 && !last.full && cursor.group < in.group_count);
    EXPECT_TRUE(same_cache(made, wanted, step.fixed.slabs != nullptr));
    EXPECT_TRUE(made.intact());
    EXPECT_TRUE(wanted.intact());
    EXPECT_LE(made.pair_count, made.pair_capacity);
    EXPECT_LE(made.row_count, made.row_capacity);
    return last.full;
  }

  // Both turn the rows of a cache, select pairs and add them up, all of them and parts.
  void test_both(const SearchStep& step, const SearchPose& pose, const CacheLanes& cache,
                 const ContactRule& rule) {
    const bool slabs = step.fixed.slabs != nullptr;
    GuardedRows wanted_rows(cache.row_capacity), rows(cache.row_capacity);
    turn_cache_scalar(cache, step, pose, false, wanted_rows);
    kernels_.turn_cache(cache, step, pose, false, rows);
    EXPECT_TRUE(rows.same(wanted_rows, cache.row_count, slabs, false));
    turn_cache_scalar(cache, step, pose, true, wanted_rows);
    kernels_.turn_cache(cache, step, pose, true, rows);
    EXPECT_TRUE(rows.same(wanted_rows, cache.row_count, slabs, true));
    EXPECT_TRUE(rows.intact());
    const std::size_t pairs = cache.pair_count;
    for (std::size_t begin = 0, end = pairs; begin <= pairs;) {
      Guarded<std::uint32_t> wanted(end - begin + kCacheSpare, 0),
          made(end - begin + kCacheSpare, 0);
      const std::size_t count =
          select_cache_scalar(cache, step, wanted_rows, begin, end, wanted.data());
      EXPECT_EQ(kernels_.select_cache(cache, step, rows, begin, end, made.data()), count);
      EXPECT_TRUE(std::equal(made.data(), made.data() + count, wanted.data()));
      EXPECT_TRUE(made.intact());
      add_both(step, cache, wanted_rows, rows, begin, end, rule);
      selected_ += count;
      begin += 16 * (1 + random_.below(1 + pairs / 24));
      end = begin + random_.below(pairs - std::min(pairs, begin) + 1);
    }
  }

  void add_both(const SearchStep& step, const CacheLanes& cache, const CacheRows& wanted_rows,
                const CacheRows& rows, std::size_t begin, std::size_t end,
                const ContactRule& rule) {
    TermsRecorder wanted_terms, made_terms;
    for (ContactAdder* adder : {wanted_.get(), made_.get()}) {
      adder->clear();
      adder->rule = rule;
    }
    wanted_->stream = &wanted_terms;
    made_->stream = &made_terms;
    add_cache_scalar(cache, step, wanted_rows, begin, end, *wanted_);
    kernels_.add_cache(cache, step, rows, begin, end, *made_);
    EXPECT_TRUE(same(made_->totals, wanted_->totals));
    EXPECT_TRUE(made_terms.is(wanted_terms));
    EXPECT_EQ(made_terms.fixed.size(), made_->totals.counted);
    // Nobody need take the terms.
    const ContactTotals totals = made_->totals;
    made_->clear();
    made_->stream = nullptr;
    kernels_.add_cache(cache, step, rows, begin, end, *made_);
    EXPECT_TRUE(same(made_->totals, totals));
    counted_ += totals.counted;
  }

  const Kernels& kernels_ = select_kernels(GetParam());
  const std::unique_ptr<SearchScratch> scratch_ = std::make_unique<SearchScratch>();
  const std::unique_ptr<ContactAdder> wanted_ = std::make_unique<ContactAdder>(),
                                      made_ = std::make_unique<ContactAdder>();
  Random random_{1};
  std::uint64_t selected_ = 0, counted_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Targets, CacheKernels, ::testing::ValuesIn(vector_targets()), name_of);

TEST_P(CacheKernels, AreTheScalarFormAfterASearch) {
  std::size_t most_pairs = 0;
  for (const auto& search : all_plans()) {
    SCOPED_TRACE(std::string(to_string(search->policy)));
    const SearchStep& last = search->plan.steps().back();
    for (const double pads : {0.02, 0.2}) {
      const SearchPose pose = random_pose(random_, pads);
      const auto in = before_last(*search, pose, *scratch_);
      GuardedCache wanted(kRoomy, kRoomy), made(kRoomy, kRoomy);
      for (const std::uint64_t most :
           {~std::uint64_t{0}, std::uint64_t{2000}, std::uint64_t{449}}) {
        ASSERT_FALSE(advance_both(last, pose, *in, wanted, made, most));
      }
      most_pairs = std::max(most_pairs, made.pair_count);
      SearchPose other = random_pose(random_, pads);
      std::copy_n(pose.rotation, 9, other.rotation);
      for (const SearchPose& at : {pose, other, random_pose(random_, pads)}) {
        test_both(last, at, made, rule_of(*search, random_.below(2) == 0 ? 2 : 0.25));
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(most_pairs, 4'000u);
  EXPECT_GT(selected_, 50'000u);
  EXPECT_GT(counted_, 20'000u);
}

// Fewer tests than a piece has: no progress, and no harm.
TEST_P(CacheKernels, AreTheScalarFormWhereTestsAreTooFew) {
  for (const auto& search : all_plans()) {
    const SearchPose pose = random_pose(random_, 0.05);
    const auto in = before_last(*search, pose, *scratch_);
    GuardedCache wanted(kRoomy, kRoomy), made(kRoomy, kRoomy);
    for (const std::uint64_t most : {0u, 1u, 7u, 8u, 40u, 64u, 200u}) {
      advance_both(search->plan.steps().back(), pose, *in, wanted, made, most);
    }
    if (HasFailure()) return;
  }
}

// However little room there is, of pairs or of rows.
TEST_P(CacheKernels, AreTheScalarFormInACacheThatIsFull) {
  int full = 0, not_full = 0;
  for (const auto& search : all_plans()) {
    SCOPED_TRACE(std::string(to_string(search->policy)));
    const SearchPose pose = random_pose(random_, 0.1);
    const auto in = before_last(*search, pose, *scratch_);
    const SearchStep& last = search->plan.steps().back();
    GuardedCache whole(kRoomy, kRoomy), also(kRoomy, kRoomy);
    advance_both(last, pose, *in, whole, also, ~std::uint64_t{0});
    const std::size_t rows = whole.row_count, pairs = whole.pair_count;
    std::vector<std::pair<std::size_t, std::size_t>> sizes = {
        {1, 1}, {rows + 1, pairs / 2 + 1}, {rows / 2 + 1, pairs + 1}, {rows + 1, 449}};
    for (const std::size_t room : {0u, 1u, 8u, 100u, 447u, 448u, 449u}) {
      sizes.emplace_back(rows + 1, pairs + room);
      sizes.emplace_back(rows + room, pairs + 8 * 448);
    }
    for (const auto& [row_room, pair_room] : sizes) {
      GuardedCache wanted(std::max<std::size_t>(row_room, 1), std::max<std::size_t>(pair_room, 1)),
          made(wanted.row_capacity, wanted.pair_capacity);
      for (const std::uint64_t most : {~std::uint64_t{0}, std::uint64_t{500}}) {
        ++(advance_both(last, pose, *in, wanted, made, most) ? full : not_full);
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(full, 200);
  EXPECT_GT(not_full, 100);
}

// What cannot be compared is kept, at the pose of the cache and at others.
TEST_P(CacheKernels, AreTheScalarFormAtAPoseThatIsNoNumber) {
  for (const auto& search : all_plans()) {
    SCOPED_TRACE(std::string(to_string(search->policy)));
    const SearchPose pose = random_pose(random_, 0.05);
    const auto in = before_last(*search, pose, *scratch_);
    const SearchStep& last = search->plan.steps().back();
    GuardedCache wanted(kRoomy, kRoomy), made(kRoomy, kRoomy);
    for (int k = 0; k < 3; ++k) {
      SearchPose bad = pose;
      if (k == 0) bad.translation[0] = kNoNumber;
      if (k == 1) bad.rotation[5] = kNoNumber;
      if (k == 2) bad.leaf.ball = bad.inner.ball = kNoNumber;
      advance_both(last, bad, *in, wanted, made, ~std::uint64_t{0});
      EXPECT_GT(in->group_count == 0 ? 1 : made.pair_count, 0u);
      test_both(last, bad, made, rule_of(*search, 2));
      test_both(last, pose, made, rule_of(*search, 2));
      advance_both(last, pose, *in, wanted, made, ~std::uint64_t{0});
      test_both(last, bad, made, rule_of(*search, 2));
      if (HasFailure()) return;
    }
  }
}

TEST_P(CacheKernels, OfNoPairsAreNone) {
  const PlannedSearch& search = *all_plans().front();
  const SearchStep& last = search.plan.steps().back();
  const SearchPose pose = random_pose(random_, 0);
  GuardedCache wanted(1, 1), made(1, 1);
  const GuardedFrontier none(1, 0);
  EXPECT_FALSE(advance_both(last, pose, none, wanted, made, ~std::uint64_t{0}));
  EXPECT_EQ(made.pair_count, 0u);
  test_both(last, pose, made, rule_of(search, 2));
  EXPECT_EQ(selected_ + counted_, 0u);
  TermsRecorder terms;
  made_->clear();
  made_->stream = &terms;
  GuardedRows rows(1);
  kernels_.add_cache(made, last, rows, 0, 0, *made_);
  EXPECT_EQ(terms.batches, 0);
}

// The scalar kernels of a cache agree with a search. A cache is made at one pose with a margin. At
// this pose and at poses near it, it gives the leaf pairs of a search.

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

// A random pose. Two bodies of all_plans() are likely to touch there.
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

  // Compares the leaf pairs of the cache with the leaf pairs of a search. Returns their number.
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
