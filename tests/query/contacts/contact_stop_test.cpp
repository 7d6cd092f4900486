// Where a search for contacts stops: the budget contract of every verb.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/test_clocks.h"

namespace ist::test {
namespace {

bool same_end(const QueryResult& a, const QueryResult& b) {
  return a.sphere_tests == b.sphere_tests && a.level == b.level && a.complete == b.complete &&
         a.distance->lower == b.distance->lower && a.distance->upper == b.distance->upper;
}

// A contact search stops where the list of leaf pairs stops. Its upper end: interval_test.
TEST(StoppedContacts, StopWhereTheListStops) {
  int stopped = 0, with_some = 0;
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const int workers : {1, 2}) {
        Query query(scene.fixed, scene.moving, options_of(policy, "", workers));
        ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
        for (const double x : {0.0, 1.6, 1.9, 2.6}) {
          Eigen::Isometry3d at = scene.pose;
          at.translation()[0] += x;
          const QueryResult whole = query.contacts(at, points);
          for (const std::uint64_t tests : {0u, 1u, 9u, 100u, 900u, 7'000u, 40'000u, 10'000'000u}) {
            const Budget budget{.tests = tests};
            const QueryResult told = query.contacts(at, points, budget);
            EXPECT_LE(told.sphere_tests, std::max<std::uint64_t>(tests, 1));
            const QueryResult list = query.leaf_pairs(at, {}, budget);
            if (told.complete) {
              EXPECT_TRUE(same_end(told, whole));
              EXPECT_EQ(told.leaf_pairs, list.leaf_pairs);
              continue;
            }
            ++stopped;
            with_some += told.leaf_pairs > 0 ? 1 : 0;
            EXPECT_EQ(told.sphere_tests, list.sphere_tests);
            EXPECT_EQ(told.level, list.level);
            EXPECT_EQ(told.distance->lower, list.distance->lower);
          }
        }
      }
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(with_some, 10);
}

// Nor does a reach widen what the bounds tell of the distance.
TEST(StoppedContacts, TellNoWiderIntervalWithAReach) {
  int stopped = 0;
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold plain(scene.fixed, scene.moving, policy, {.margin = 2});
      for (const double reach : {0.375, 1.0}) {
        ManifoldOptions options;
        options.reach = reach;
        ContactManifold wide(scene.fixed, scene.moving, policy, options);
        for (const double x : {0.0, 1.6, 1.9, 2.6}) {
          Eigen::Isometry3d at = scene.pose;
          at.translation()[0] += x;
          const DistanceInterval roots = *query.contacts(at, plain, {.tests = 0}).distance;
          for (const std::uint64_t tests : {0u, 9u, 900u, 7'000u}) {
            const QueryResult told = query.contacts(at, wide, {.tests = tests});
            if (!told.complete) {
              EXPECT_TRUE(wide.points().empty());
            }
            EXPECT_GE(told.distance->lower, roots.lower);
            EXPECT_LE(told.distance->upper, roots.upper);
            stopped += told.complete ? 0 : 1;
          }
        }
      }
    }
  }
  EXPECT_GT(stopped, 50);
}

TEST(StoppedContacts, EndAtTheFirstLookAfterTheDeadline) {
  const ScopedBudgetClock clock(LateClock::now);
  const Scene& scene = solids()[0];
  for (const SpherePolicy policy : kSpherePolicies) {
    Query query(scene.fixed, scene.moving, options_of(policy));
    ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
    std::uint64_t before = 0;
    for (int allowed = 0; allowed < 40; ++allowed) {
      const QueryResult stopped = query.contacts(scene.pose, points, LateClock::budget_of(allowed));
      EXPECT_FALSE(stopped.complete);
      EXPECT_EQ(LateClock::looks, allowed + 1);
      EXPECT_LE(stopped.sphere_tests, before + BudgetMeter::kUnwatchedTests + 1);
      const ContactSums sums = points.sums();
      EXPECT_TRUE(
          same_end(query.contacts(scene.pose, points, {.tests = stopped.sphere_tests}), stopped));
      EXPECT_EQ(points.sums().weight, sums.weight);
      EXPECT_EQ(points.sums().pairs, sums.pairs);
      before = stopped.sphere_tests;
    }
  }
}

// Counts the tests and pairs from one look at the clock to the next.
struct Watched : ContactVisitor {
  Watched(const SearchPose& pose, ContactOutput& sink, const BudgetMeter& meter)
      : ContactVisitor(pose, sink, meter), sink_(sink) {}
  Advanced advance(const SearchBatch& batch) noexcept {
    const std::uint64_t looks = FakeClock::looks, pairs = sink_.count();
    const Advanced made = ContactVisitor::advance(batch);
    EXPECT_EQ(FakeClock::looks, looks + 1);
    most_tests = std::max(most_tests, made.tests);
    most_pairs = std::max(most_pairs, sink_.count() - pairs);
    return made;
  }
  std::uint64_t most_tests = 0, most_pairs = 0;

 private:
  ContactOutput& sink_;
};

TEST(StoppedContacts, ReadTheClockOftenEnough) {
  const Scene& scene = shells();
  const SpherePolicy policy = SpherePolicy::kSlab;
  const SearchPlan plan(scene.fixed, scene.moving, policy);
  const Kernels& kernels = select_kernels("");
  Search search(plan, kernels, 1 << 16);
  detail::ContactReducer reducer(scene.fixed, scene.moving, policy, {});
  const SearchPose pose = to_float(
      *relative_pose(scene.pose, parts_of(scene.fixed).lattice, parts_of(scene.moving).lattice),
      lengths_of(scene.fixed, policy), lengths_of(scene.moving, policy));
  ContactOutput sink(plan, kernels, pose, reducer.adder(), reducer.leaf_sums());
  const Budget budget{.deadline = Budget::Clock::time_point(std::chrono::seconds(1))};
  const ScopedBudgetClock clock(FakeClock::now);
  Watched watched(pose, sink, BudgetMeter(budget));
  EXPECT_EQ(search.run(watched), plan.steps().size());
  EXPECT_LE(watched.most_tests, 500u);  // as Budget states
  EXPECT_LE(watched.most_pairs, 512u);
  EXPECT_GT(watched.most_pairs, 32u);
}

}  // namespace
}  // namespace ist::test
