// The search that fills a front gives the same one in parts of any size as in one go, float for
// float.

#include "ist/query/coherent/front_search.h"

#include <gtest/gtest.h>

#include <string>

#include "query/coherent/front_case.h"
#include "query/test_clocks.h"

namespace ist::test {
namespace {

using State = FrontSearch::State;

constexpr std::size_t kRoom = 1 << 17;
// Each slice of kPiece tests goes on: a piece of a step has no more.
constexpr std::uint64_t kPiece = kPieceTests;

class FrontSearchOf : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  // Makes a front slice by slice. Returns the number of slices.
  template <class Slice>
  static int in_slices(FrontSearch& search, Front& front, const FrontSearch::Wanted& wanted,
                       const Slice& slice) {
    search.begin(front, wanted);
    int slices = 0;
    std::uint64_t spent = 0;
    while (search.state() == State::kUnderWay && slices < 100'000) {
      const std::uint64_t tests = slice(slices);
      search.advance({.tests = tests});
      EXPECT_LE(search.tests() - spent, tests);
      spent = search.tests();
      ++slices;
    }
    EXPECT_EQ(search.state(), State::kDone);
    return slices;
  }

  // The poses of a scene: where it is, and moved apart by some voxels.
  static std::vector<Eigen::Isometry3d> poses(const Scene& scene) {
    std::vector<Eigen::Isometry3d> all{scene.pose};
    Random random(5);
    for (const double far : {0.3, 1.0, 3.0}) {
      all.push_back(scene.pose);
      all.back().translation() += far * random.direction();
    }
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, FrontSearchOf, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(FrontSearchOf, GivesInSlicesWhatItGivesInOneGo) {
  Random random(1);
  std::size_t pairs = 0;
  int slices = 0;
  for (const Scene& scene : solids()) {
    const FrontCase scene_case(scene.fixed, scene.moving, GetParam());
    const bool slabs = GetParam() == SpherePolicy::kSlab;
    Front whole(kRoom), sliced(kRoom);
    FrontSearch search(scene_case.plan, scene_case.kernels, 1 << 16),
        tiny(scene_case.plan, scene_case.kernels, 1);
    for (const Eigen::Isometry3d& pose : poses(scene)) {
      // With the widest the rows of inner steps are longer than a piece.
      for (const double voxels : {0.0, 0.4, 1.5, 8.0}) {
        SCOPED_TRACE(scene.name + ", " + std::to_string(voxels) + " voxels");
        const auto wanted = scene_case.wanted(scene_case.relative(pose), voxels * scene_case.voxel);
        search.begin(whole, wanted);
        if (search.advance({}) == State::kFull) continue;
        const std::uint64_t all = search.tests();
        pairs += whole.lanes.pair_count;
        const auto check = [&](FrontSearch& with, const auto& slice, bool same_tests) {
          slices += in_slices(with, sliced, wanted, slice);
          EXPECT_TRUE(same_front(sliced, whole, slabs));
          EXPECT_TRUE(!same_tests || with.tests() == all) << with.tests() << " for " << all;
        };
        for (const std::uint64_t tests :
             {kPiece, kPiece + 1, std::uint64_t{777}, std::uint64_t{2000}, std::uint64_t{20'000}}) {
          check(
              search, [&](int) { return tests; }, true);
        }
        check(
            search, [&](int k) { return k == 0 ? all - 1 : kPiece; }, true);
        check(
            search, [&](int) { return 1 + random.below(3 * kPiece); }, true);
        check(
            tiny, [&](int) { return 1 + random.below(5000); }, true);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(pairs, 50'000u);
  EXPECT_GT(slices, 2'000);
}

// The clock ends a part as a number of tests does.
TEST_P(FrontSearchOf, GoesOnAfterADeadline) {
  const Scene& scene = solids()[0];
  const FrontCase scene_case(scene.fixed, scene.moving, GetParam());
  Front whole(kRoom), parts(kRoom);
  FrontSearch search(scene_case.plan, scene_case.kernels, 1 << 16);
  const auto wanted = scene_case.wanted(scene_case.relative(scene.pose), 0.4 * scene_case.voxel);
  search.begin(whole, wanted);
  ASSERT_EQ(search.advance({}), State::kDone);
  const std::uint64_t all = search.tests();
  for (const int looks : {1, 2, 3, 10}) {
    search.begin(parts, wanted);
    int times = 0;
    while (search.state() == State::kUnderWay && ++times < 10'000) {
      search.advance(LateClock::budget_of(looks));
    }
    EXPECT_EQ(search.state(), State::kDone) << looks << " looks";
    EXPECT_GT(times, 1);
    EXPECT_EQ(search.tests(), all);
    EXPECT_TRUE(same_front(parts, whole, GetParam() == SpherePolicy::kSlab));
  }
  // A deadline that is past leaves it as it is.
  search.begin(parts, wanted);
  EXPECT_EQ(search.advance(LateClock::budget_of(0)), State::kUnderWay);
  EXPECT_EQ(search.tests(), 0u);
  EXPECT_EQ(search.advance({}), State::kDone);
  EXPECT_TRUE(same_front(parts, whole, GetParam() == SpherePolicy::kSlab));
}

TEST_P(FrontSearchOf, EndsWhereTheFrontIsFullOrTheTestsAreTooMany) {
  const Scene& scene = solids()[0];
  const FrontCase scene_case(scene.fixed, scene.moving, GetParam());
  FrontSearch search(scene_case.plan, scene_case.kernels, 1 << 16);
  const auto wanted = scene_case.wanted(scene_case.relative(scene.pose), 0.4 * scene_case.voxel);
  Front whole(kRoom);
  search.begin(whole, wanted);
  ASSERT_EQ(search.advance({}), State::kDone);
  const std::uint64_t all = search.tests();
  for (const std::size_t room : {std::size_t{1}, std::size_t{100}, whole.lanes.pair_count - 1}) {
    Front small(room);
    search.begin(small, wanted);
    EXPECT_EQ(search.advance({}), State::kFull) << room;
    EXPECT_LE(small.lanes.pair_count, room);
    EXPECT_EQ(search.advance({}), State::kFull);  // and it stays so
    search.begin(small, wanted);
    int slices = 0;
    while (search.advance({.tests = 2000}) == State::kUnderWay) ++slices;
    EXPECT_EQ(search.state(), State::kFull) << room;
    EXPECT_GT(slices, 0);
  }
  Front some(kRoom);
  for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1000}, all - 1, all, all + 1}) {
    for (const std::uint64_t slice : {~std::uint64_t{0}, std::uint64_t{1500}}) {
      search.begin(some, scene_case.wanted(wanted.centre, wanted.extent, most));
      int slices = 0;
      while (search.advance({.tests = slice}) == State::kUnderWay && slices < 10'000) ++slices;
      EXPECT_EQ(search.state(), most >= all ? State::kDone : State::kFull)
          << most << " of " << all << " in slices of " << slice;
      EXPECT_LE(search.tests(), most);
    }
  }
  // What is dropped is not gone on with; the next one is whole again.
  search.begin(some, wanted);
  search.advance({.tests = 5000});
  search.drop();
  EXPECT_EQ(search.advance({}), State::kNone);
  search.begin(some, wanted);
  EXPECT_EQ(search.advance({}), State::kDone);
  EXPECT_TRUE(same_front(some, whole, GetParam() == SpherePolicy::kSlab));
}

// An empty front bounds the distance from above, unless that was not asked for.
TEST_P(FrontSearchOf, BoundsTheDistanceOfBodiesThatAreApart) {
  const Scene& scene = solids()[0];  // a ball of radius 1, a block whose face is at x = -0.9
  const FrontCase scene_case(scene.fixed, scene.moving, GetParam());
  FrontSearch search(scene_case.plan, scene_case.kernels, 1 << 16);
  Front front(kRoom);
  for (const double gap : {0.2, 0.3, 0.5}) {
    auto wanted = scene_case.wanted(scene_case.relative(shift({1.9 + gap, 0, 0})), 0.1);
    search.begin(front, wanted);
    ASSERT_EQ(search.advance({}), State::kDone);
    EXPECT_TRUE(front.empty());
    EXPECT_GE(front.upper, gap - 1e-9);
    EXPECT_TRUE(std::isfinite(front.upper));
    wanted.measured = Measured::kNothing;
    search.begin(front, wanted);
    ASSERT_EQ(search.advance({}), State::kDone);
    EXPECT_EQ(front.upper, HUGE_VAL);
  }
}

}  // namespace
}  // namespace ist::test
