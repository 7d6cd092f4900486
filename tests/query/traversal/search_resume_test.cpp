// A search in parts finds the same pairs as a search in one go, in the same order. The ends of the
// parts and the size of the memory make no difference.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"

namespace ist::test {
namespace {

class ResumedSearch : public ::testing::TestWithParam<SpherePolicy> {
 protected:
  // Returns all leaf pairs of a search in parts. Part `part` makes `tests(part)` tests.
  template <class Tests>
  static std::vector<LeafPair> in_parts(Search& search, const SearchPlan& plan,
                                        const SearchPose& pose, std::size_t room,
                                        const Tests& tests) {
    std::vector<LeafPair> out(room);
    LeafPairSink sink(plan, select_kernels(""), out);
    SearchPosition at = search.roots();
    for (int part = 0; !at.is_end() && part < 1'000'000; ++part) {
      PairLister lister(pose, sink, BudgetMeter({.tests = tests(part)}));
      at = search.resume(at, lister);
    }
    EXPECT_TRUE(at.is_end());
    EXPECT_LE(sink.count(), room);
    out.resize(sink.count());
    return out;
  }
};

INSTANTIATE_TEST_SUITE_P(Policies, ResumedSearch, ::testing::ValuesIn(kSpherePolicies),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

TEST_P(ResumedSearch, FindsTheSamePairsInTheSameOrder) {
  Random random(1);
  std::size_t found = 0;
  for (const Scene& scene : solids()) {
    const SearchPlan plan(scene.fixed, scene.moving, GetParam());
    const TreeLengths fixed = lengths_of(scene.fixed, GetParam()),
                      moving = lengths_of(scene.moving, GetParam());
    const RelativePose relative =
        *relative_pose(scene.pose, parts_of(scene.fixed).lattice, parts_of(scene.moving).lattice);
    // With the largest margin the rows of inner steps are longer than a piece.
    for (const double voxels : {0.0, 1.0, 5.0}) {
      const double voxel = std::min(scene.fixed.voxel_size(), scene.moving.voxel_size());
      const SearchPose pose = to_float(relative, fixed, moving, voxels * voxel);
      Search wide(plan, select_kernels(""), 1 << 16);
      std::vector<LeafPair> all(1 << 20);
      LeafPairSink sink(plan, select_kernels(""), all);
      PairLister lister(pose, sink);
      wide.run(lister);
      ASSERT_LE(sink.count() + 100, all.size());
      all.resize(sink.count());
      found += all.size();
      for (const std::size_t memory : {std::size_t{1} << 16, std::size_t{300}, std::size_t{1}}) {
        SCOPED_TRACE(scene.name + ", " + std::to_string(voxels) + " voxels, memory for " +
                     std::to_string(memory));
        Search search(plan, select_kernels(""), memory);
        for (const std::uint64_t tests : {448u, 449u, 1000u, 30'000u}) {
          EXPECT_EQ(in_parts(search, plan, pose, all.size() + 100, [&](int) { return tests; }), all)
              << tests;
        }
        // Some of these parts are too small for any test.
        EXPECT_EQ(
            in_parts(search, plan, pose, all.size() + 100, [&](int) { return random.below(2000); }),
            all);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(found, 50'000u);
}

// A search that was left unfinished does not change the next one.
TEST_P(ResumedSearch, IsForgottenByTheNextOne) {
  const Scene& scene = solids()[1];
  const SearchPlan plan(scene.fixed, scene.moving, GetParam());
  const RelativePose relative =
      *relative_pose(scene.pose, parts_of(scene.fixed).lattice, parts_of(scene.moving).lattice);
  const SearchPose pose = to_float(relative, lengths_of(scene.fixed, GetParam()),
                                   lengths_of(scene.moving, GetParam()), 0.2);
  Search search(plan, select_kernels(""), 1 << 16);
  std::vector<LeafPair> expected;
  for (std::uint64_t tests = 0; tests < 20'000; tests = tests * 5 / 4 + 100) {
    std::vector<LeafPair> out(1 << 20), unused(1 << 20);
    LeafPairSink cut(plan, select_kernels(""), unused), sink(plan, select_kernels(""), out);
    if (tests > 0) {
      PairLister some(pose, cut, BudgetMeter({.tests = tests}));
      static_cast<void>(search.resume(search.roots(), some));
    }
    PairLister all(pose, sink);
    ASSERT_TRUE(search.resume(search.roots(), all).is_end());
    out.resize(sink.count());
    if (tests == 0) expected = out;
    ASSERT_GT(out.size(), 100u);
    ASSERT_EQ(out, expected) << tests;
  }
}

}  // namespace
}  // namespace ist::test
