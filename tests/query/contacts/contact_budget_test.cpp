#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/contacts/contact_visitor.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/query/workers/shared_work.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "support/effort.h"

namespace ist::test {
namespace {

// Contacts under a budget. A large budget changes nothing, and a small one cuts at its number of
// tests.

constexpr std::array kPolicies = {SpherePolicy::kTable, SpherePolicy::kSlab};

FoundContacts find_contacts_within(Query& query, ContactManifold& points,
                                   const Eigen::Isometry3d& pose, const Budget& budget) {
  const QueryResult result = query.contacts(pose, points, budget);
  return {points.sums(), {points.points().begin(), points.points().end()}, result};
}

TEST(ContactsWithinABudget, WithoutEndAreThoseOfThePlainQuery) {
  for (const Scene& scene : Scenes{solids()[0], solids()[1], solids()[2], shells()}) {
    for (const SpherePolicy policy : kPolicies) {
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
      const FoundContacts plain = find_contacts(query, points, scene.pose);
      ASSERT_GT(plain.points.size(), 8u) << scene.name;
      {
        SCOPED_TRACE(scene.name);
        const FoundContacts found = find_contacts_within(query, points, scene.pose, {});
        EXPECT_TRUE(same(found, plain));
        EXPECT_TRUE(found.result.complete);
        EXPECT_EQ(found.result.level, 0);
        EXPECT_EQ(found.result.leaf_pairs, plain.result.leaf_pairs);
        EXPECT_EQ(found.result.sphere_tests, plain.result.sphere_tests);
        EXPECT_EQ(found.result.pad, plain.result.pad);
      }
    }
  }
}

// A budget of the tests that a stopped query spent stops the next query at the same place, so a
// recording can be repeated.
TEST(ContactsWithinABudget, StopWhereTheyStoppedBefore) {
  int stopped = 0, with_sums = 0;
  for (const Scene& scene : Scenes{solids()[0], solids()[2], shells()}) {
    for (const SpherePolicy policy : kPolicies) {
      Query query(scene.fixed, scene.moving, options_of(policy));
      Query other(scene.fixed, scene.moving, options_of(policy));
      ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
      ContactManifold others(scene.fixed, scene.moving, policy, {.margin = 2});
      const std::uint64_t all = query.contacts(scene.pose, points).sphere_tests;
      {
        for (std::uint64_t tests = 1; tests < 2 * all; tests = tests * 7 / 4 + 1) {
          SCOPED_TRACE(scene.name + ", " + std::to_string(tests) + " tests");
          const FoundContacts first =
              find_contacts_within(query, points, scene.pose, {.tests = tests});
          const FoundContacts again =
              find_contacts_within(other, others, scene.pose, {.tests = first.result.sphere_tests});
          EXPECT_TRUE(same(first, again));
          EXPECT_EQ(again.result.sphere_tests, first.result.sphere_tests);
          EXPECT_EQ(again.result.complete, first.result.complete);
          EXPECT_EQ(again.result.level, first.result.level);
          EXPECT_EQ(again.result.leaf_pairs, first.result.leaf_pairs);
          EXPECT_EQ(again.result.distance->lower, first.result.distance->lower);
          EXPECT_EQ(again.result.distance->upper, first.result.distance->upper);
          EXPECT_LE(first.result.leaf_pairs, query.contacts(scene.pose, points).leaf_pairs);
          EXPECT_TRUE(first.result.complete || tests < all);
          stopped += first.result.complete ? 0 : 1;
          EXPECT_EQ(first.points.empty(), !first.result.complete);
          with_sums += !first.result.complete && first.sums.weight > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(stopped, 50);
  EXPECT_GT(with_sums, 10);
}

// The clock is late from any look on. The tests that it had made stop it there too.
TEST(ContactsWithinADeadline, StopWhereTheyStoppedBefore) {
  const ScopedBudgetClock clock(LateClock::now);
  const Scene& scene = jaws();
  int stopped = 0;
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
  {
    for (int i = 0; i < 40; ++i) {
      const FoundContacts first =
          find_contacts_within(query, points, scene.pose, LateClock::budget_of(i));
      const FoundContacts again =
          find_contacts_within(query, points, scene.pose, {.tests = first.result.sphere_tests});
      EXPECT_TRUE(same(first, again)) << i;
      EXPECT_EQ(again.result.sphere_tests, first.result.sphere_tests);
      EXPECT_EQ(again.result.complete, first.result.complete);
      EXPECT_EQ(again.result.level, first.result.level);
      EXPECT_EQ(again.result.distance->upper, first.result.distance->upper);
      stopped += first.result.complete ? 0 : 1;
    }
  }
  EXPECT_GT(stopped, 5);
}

// Two workers share a query with a deadline. If the clock ends it early, the answer does not depend
// on the worker, and equals the answer with a budget of as many tests.
TEST(ContactsOfTwoWorkers, AreThoseOfOneAndStopWhereTheyStoppedBefore) {
  IST_SLOW();
  const Scene& scene = jaws();
  QueryOptions options = options_of(SpherePolicy::kSlab);
  Query one(scene.fixed, scene.moving, options);
  options.workers = 2;
  options.period = std::chrono::nanoseconds(0);
  Query two(scene.fixed, scene.moving, options);
  ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
  const FoundContacts whole = find_contacts_within(one, points, scene.pose, {});
  ASSERT_GT(whole.result.leaf_pairs, 1000u);
  int stopped = 0;
  for (int i = 0; i < 400 || sharing_of(two).chunks < 20; ++i) {
    Budget budget{.deadline = Budget::Clock::now()};
    budget.deadline += i < 200 ? std::chrono::microseconds(2 * i) : std::chrono::hours(1);
    const FoundContacts first = find_contacts_within(two, points, scene.pose, budget);
    if (first.result.complete) {
      EXPECT_TRUE(same(first, whole)) << i;
      EXPECT_EQ(first.result.leaf_pairs, whole.result.leaf_pairs);
      EXPECT_EQ(first.result.sphere_tests, whole.result.sphere_tests);
    }
    const FoundContacts again =
        find_contacts_within(two, points, scene.pose, {.tests = first.result.sphere_tests});
    EXPECT_EQ(again.result.complete, first.result.complete) << i;
    EXPECT_EQ(again.result.sphere_tests, first.result.sphere_tests);
    EXPECT_EQ(again.result.leaf_pairs, first.result.leaf_pairs);
    EXPECT_EQ(again.result.level, first.result.level);
    EXPECT_EQ(again.result.distance->lower, first.result.distance->lower);
    EXPECT_EQ(again.result.distance->upper, first.result.distance->upper);
    stopped += first.result.complete ? 0 : 1;
  }
  EXPECT_GT(stopped, 5);
  EXPECT_LE(stopped, 200);
}

TEST(ContactsWithinADeadline, ThatIsPastAreNone) {
  {
    const Scene& scene = solids()[0];
    Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
    ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
    const FoundContacts found =
        find_contacts_within(query, points, scene.pose, {.deadline = Budget::Clock::now()});
    EXPECT_FALSE(found.result.complete);
    EXPECT_EQ(found.result.sphere_tests, 1u);
    EXPECT_EQ(found.result.leaf_pairs, 0u);
    EXPECT_EQ(found.result.level, std::max(scene.fixed.depth(), scene.moving.depth()));
    EXPECT_TRUE(found.points.empty());
    EXPECT_EQ(found.sums.weight, 0);
    // A query of separate roots ends at once.
    const FoundContacts apart =
        find_contacts_within(query, points, shift({9, 0, 0}), {.deadline = Budget::Clock::now()});
    EXPECT_TRUE(apart.result.complete);
    EXPECT_GT(apart.result.distance->lower, 5);
  }
}

// A ball of radius 1 beside the block's face at x = 0.9, at this distance along x. The interval
// holds the distance for every budget, and narrows with it. A measured interval is at most as wide
// as an unmeasured one.
TEST(ContactsWithinABudget, TellATrueDistance) {
  const Scene& scene = solids()[0];
  for (const SpherePolicy policy : kPolicies) {
    Query query(scene.fixed, scene.moving, options_of(policy));
    ContactManifold points(scene.fixed, scene.moving, policy, {.margin = 2});
    for (const double distance : {1.0, 0.3, 0.05, 0.002}) {
      const Eigen::Isometry3d pose = shift({1.9 + distance, 0, 0});
      DistanceInterval before{0, HUGE_VAL};
      for (const std::uint64_t tests : {0u, 1u, 30u, 400u, 3'000u, 50'000u, 10'000'000u}) {
        SCOPED_TRACE(std::to_string(distance) + " apart, " + std::to_string(tests) + " tests");
        const DistanceInterval wide = *query.contacts(pose, points, {.tests = tests}).distance;
        const QueryResult result = query.leaf_pairs(pose, std::span<LeafPair>(), {.tests = tests});
        const DistanceInterval narrow = *result.distance;
        for (const DistanceInterval& gap : {wide, narrow}) {
          EXPECT_LE(gap.lower, distance + 1e-9);
          EXPECT_GE(gap.upper, distance - 1e-9);
        }
        EXPECT_GE(narrow.lower, wide.lower);
        EXPECT_LE(narrow.upper, wide.upper);
        EXPECT_GE(narrow.lower, before.lower);
        EXPECT_LE(narrow.upper, before.upper);
        before = narrow;
        EXPECT_TRUE(result.leaf_pairs == 0 || tests < 10'000'000 ||
                    wide.upper <= result.resolution);
      }
    }
  }
}

TEST(ContactsWithinABudget, AreNoneAtNoRigidMotion) {
  const Scene& scene = solids()[0];
  Query query(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
  Eigen::Isometry3d bad = scene.pose;
  bad.linear() *= 2;
  {
    EXPECT_TRUE(find_contacts_within(query, points, scene.pose, {}).result.complete);
    const FoundContacts none = find_contacts_within(query, points, bad, {});
    EXPECT_EQ(none.result.status, QueryStatus::kInvalidPose);
    EXPECT_FALSE(none.result.complete);
    EXPECT_TRUE(none.points.empty());
    EXPECT_EQ(none.sums.weight, 0);
  }
}

// A search for contacts stops by the budget contract of every verb.

bool same_end(const QueryResult& a, const QueryResult& b) {
  return a.sphere_tests == b.sphere_tests && a.level == b.level && a.complete == b.complete &&
         a.distance->lower == b.distance->lower && a.distance->upper == b.distance->upper;
}

// A contact search stops at the same pair as the list of leaf pairs. interval_test checks the upper
// end of its distance.
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

// A reach does not widen the interval of the distance either.
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
      *relative_pose(scene.pose, parts_of(scene.fixed).origin, parts_of(scene.moving).origin),
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
