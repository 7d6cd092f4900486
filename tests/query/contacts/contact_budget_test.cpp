// Contact points under a budget: the same where it does not end, cut where it was said, and true.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ist/query/workers/sharing.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/test_clocks.h"
#include "support/effort.h"

namespace ist::test {
namespace {

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

// What a stopped query spent stops the next one at the same place: so a recording is made again.
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

// Two workers share what has a deadline; an answer that the clock ends early depends on no
// worker, and is the same with a budget of as many tests.
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
    // Roots that are apart need no time.
    const FoundContacts apart =
        find_contacts_within(query, points, shift({9, 0, 0}), {.deadline = Budget::Clock::now()});
    EXPECT_TRUE(apart.result.complete);
    EXPECT_GT(apart.result.distance->lower, 5);
  }
}

// The ball of radius 1 beside the block's face at x = 0.9, so far apart along x: the gap holds it
// whatever was spent, closer the more that was; and measured it is no wider than unmeasured.
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

}  // namespace
}  // namespace ist::test
