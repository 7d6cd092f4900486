#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/workers/sharing.h"
#include "query/query_cases.h"
#include "query/workers/shared_query_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

SphereTree shell(double radius) { return build_tree(icosphere(5, radius), {.voxel_size = 0.2}); }

struct Pairs {
  std::vector<TrianglePair> pairs;
  std::uint64_t tests = 0;
  bool complete = false;

  friend bool operator==(const Pairs&, const Pairs&) = default;
};

// A query with two workers, of two shells that cross in many places, and the answer of one.
class SharedPairsThread : public SharedQueryTest {
 protected:
  Pairs ask_for(Query& query, const Budget& budget = {}) const {
    Pairs found{std::vector<TrianglePair>(1 << 18)};
    const TrianglePairsResult result = query.triangle_pairs(pose_, found.pairs, budget);
    found.pairs.resize(result.triangle_pairs);
    found.tests = result.sphere_tests;
    found.complete = result.complete;
    return found;
  }
  bool is_right(Query& query) override { return ask_for(query) == expected_; }

  const SphereTree fixed_ = shell(1), moving_ = shell(1.0005);
  const Eigen::Isometry3d pose_ = pose_of(Random(2).rotation(), {0.002, 0.001, 0});
  const QueryOptions shared_{.workers = 2, .period = {}};
  const Pairs expected_ = [this] {
    Query query(fixed_, moving_);
    return ask_for(query);
  }();
};

TEST_F(SharedPairsThread, GiveTheAnswerOfOneWorker) {
  Query query(fixed_, moving_, shared_);
  EXPECT_GT(expected_.pairs.size(), 1000u);
  EXPECT_TRUE(expected_.complete);
  int queries = 0;
  EXPECT_TRUE(ask_until(query, [&] { return ++queries >= 100 && sharing_of(query).chunks > 20; }));
  std::cout << sharing_of(query).chunks << " chunks helped in " << queries << " queries\n";
}

TEST_F(SharedPairsThread, DoWithoutAWorkerThatStalls) {
  Query query(fixed_, moving_, shared_);
  for (const HandOver point : kHandOvers) {
    SCOPED_TRACE(static_cast<int>(point));
    {
      const Stall stall(point);
      ASSERT_TRUE(ask_until(query, Stall::reached));
      const std::uint64_t helped = sharing_of(query).chunks;
      for (int later = 0; later < 10; ++later) ASSERT_EQ(ask_for(query), expected_);
      EXPECT_EQ(sharing_of(query).chunks, helped);
    }
    ASSERT_TRUE(ask_until_helped(query));  // it works again
  }
}

// Each time it stalls it goes on in the midst of later queries.
TEST_F(SharedPairsThread, ForgetAWorkerThatIsLate) {
  Query query(fixed_, moving_, shared_);
  for (int round = 0; round < 8; ++round) {
    const Stall stall(kHandOvers[round % 4]);
    ASSERT_TRUE(ask_until(query, Stall::reached));
    ASSERT_TRUE(ask_while_let_go(query, round * 50us));
  }
}

// A deadline leaves some of the pairs; a limit of tests the same as one worker alone.
TEST_F(SharedPairsThread, KeepABudget) {
  Query query(fixed_, moving_, shared_), alone(fixed_, moving_);
  ASSERT_TRUE(ask_until_helped(query));
  bool cut = false;
  for (int i = 0; i < 60; ++i) {
    const Pairs some = ask_for(query, {.deadline = Clock::now() + i * 20us});
    EXPECT_LE(some.pairs.size(), expected_.pairs.size());
    EXPECT_TRUE(!some.complete || some.pairs.size() == expected_.pairs.size());
    EXPECT_TRUE(std::includes(expected_.pairs.begin(), expected_.pairs.end(), some.pairs.begin(),
                              some.pairs.end()));
    cut = cut || !some.complete;
    const Budget tests{.tests = static_cast<std::uint64_t>(1000 * i)};
    EXPECT_EQ(ask_for(query, tests), ask_for(alone, tests));
  }
  EXPECT_TRUE(cut);
}

}  // namespace
}  // namespace ist::test
