#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <iostream>
#include <thread>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/workers/shared_search.h"
#include "ist/query/workers/shared_work.h"
#include "query/contacts/contact_cases.h"
#include "query/query_cases.h"
#include "query/scenes.h"
#include "query/triangles/triangle_tree.h"
#include "query/workers/shared_query_case.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

// Two workers find the same contacts as one, even if the second is late or stops.

class SharedContactsThread : public SharedQueryTest {
 protected:
  bool is_right(Query& query) override {
    return same(find_contacts(query, points_, scene_.pose), expected_);
  }

  const Scene& scene_ = shells();
  const QueryOptions shared_ = options_of(SpherePolicy::kSlab, "", 2);
  ContactManifold points_{scene_.fixed, scene_.moving, SpherePolicy::kSlab};
  const FoundContacts expected_ = [this] {
    Query query(scene_.fixed, scene_.moving, options_of(SpherePolicy::kSlab));
    return find_contacts(query, points_, scene_.pose);
  }();
};

TEST_F(SharedContactsThread, AreThoseOfOneWorkerWhereTheOtherStalls) {
  Query query(scene_.fixed, scene_.moving, shared_);
  for (const HandOver point : kHandOvers) {
    {
      const Stall stall(point);
      ASSERT_TRUE(ask_until(query, Stall::reached));
      for (int later = 0; later < 10; ++later) {
        ASSERT_TRUE(is_right(query));
      }
    }
    ASSERT_TRUE(ask_until_helped(query));
  }
}

// Each time it stalls it goes on while the caller collects its parts, or in later queries.
TEST_F(SharedContactsThread, AreThoseOfOneWorkerWhereTheOtherIsLate) {
  Query query(scene_.fixed, scene_.moving, shared_);
  for (int round = 0; round < 16; ++round) {
    const Stall stall(round % 2 == 0 ? HandOver::kClaimed : HandOver::kWorked);
    ASSERT_TRUE(ask_until(query, Stall::reached));
    ASSERT_TRUE(ask_while_let_go(query, round * 25us));
  }
}

// The worker leaves a chunk to the caller if its leaves do not fit into the worker's memory.
TEST(SharedContacts, OfMoreLeavesThanTheWorkerHasRoomFor) {
  BuildOptions build;
  build.voxel_size = 2.0 / 150;
  build.spheres = SpherePolicy::kSimple;
  const SphereTree ball = build_tree(icosphere(4, 1), build);
  const Eigen::Isometry3d pose = shift({build.voxel_size / 4, 0, 0});
  ManifoldOptions options;
  options.max_leaves = 1 << 20;
  options.margin = 2;
  ContactManifold points(ball, ball, SpherePolicy::kSimple, options);
  Query single(ball, ball, options_of(SpherePolicy::kSimple));
  const FoundContacts expected = find_contacts(single, points, pose);
  EXPECT_GT(expected.points.size(), 8u);
  const Awake awake;
  Query query(ball, ball, options_of(SpherePolicy::kSimple, "", 2));
  EXPECT_TRUE(ask_until_short_of_room(
      query, [&] { return same(find_contacts(query, points, pose), expected); }));
}

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

using Eigen::Isometry3d;

// Asks every question at one pose.
struct Everything {
  FoundPairs leaf_pairs;
  DistanceInterval gap;
  std::vector<TrianglePair> triangles;
  double weight, spring;

  [[nodiscard]] bool operator==(const Everything& other) const {
    return same(leaf_pairs, other.leaf_pairs) && gap.lower == other.gap.lower &&
           gap.upper == other.gap.upper && triangles == other.triangles && weight == other.weight &&
           spring == other.spring;
  }
};

class Asker {
 public:
  Asker(const SphereTree& tree, int workers)
      : query_(tree, tree, options_of(SpherePolicy::kSlab, "", workers)),
        points_(tree, tree, SpherePolicy::kSlab),
        triangles_(1 << 14) {}

  [[nodiscard]] Everything at(const Isometry3d& pose) {
    Everything all{ask(query_, pose), query_.distance(pose, 0.01).distance, {}, 0, 0};
    const TrianglePairsResult exact = query_.triangle_pairs(pose, triangles_);
    all.triangles.assign(triangles_.begin(),
                         triangles_.begin() + static_cast<std::ptrdiff_t>(exact.triangle_pairs));
    static_cast<void>(query_.contacts(pose, points_));
    all.weight = points_.sums().weight;
    all.spring = points_.sums().spring.force.norm();
    return all;
  }

 private:
  Query query_;
  ContactManifold points_;
  std::vector<TrianglePair> triangles_;
};

// One tree, which both bodies are, and eight queries that begin together: half of them share the
// resident worker too.
TEST(SharedTreeThread, ServesAQueryOnEachThread) {
  constexpr int kThreads = 8;
  const SphereTree tree = triangle_tree(icosphere(3, 1), 16);
  std::vector<Isometry3d> poses;
  for (const double z : {2.2, 1.9, 1.4, 0.3}) poses.push_back(shift({0.1, 0.05, z}));
  std::vector<Everything> expected;
  Asker serial(tree, 1);
  for (const Isometry3d& pose : poses) expected.push_back(serial.at(pose));
  EXPECT_TRUE(expected.front().leaf_pairs.leaf_pairs.empty());
  EXPECT_GT(expected.back().leaf_pairs.leaf_pairs.size(), 1000u);

  const int rounds = samples(2);
  std::atomic<int> wrong = 0;
  std::barrier together(kThreads);
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&, thread] {
      Asker asker(tree, 1 + thread % 2);
      together.arrive_and_wait();
      for (int i = 0; i < rounds * static_cast<int>(poses.size()); ++i) {
        const std::size_t at = static_cast<std::size_t>(i + thread) % poses.size();
        if (!(asker.at(poses[at]) == expected[at])) ++wrong;
      }
    });
  }
  threads.clear();
  StabilityCase answers("load", "8 threads, 8 queries, one tree", "wrong answers");
  answers.samples_of(static_cast<std::uint64_t>(kThreads * rounds) * poses.size(), wrong, 0);
}

}  // namespace
}  // namespace ist::test
