// Contacts that two workers find are those of one, whatever becomes of the second.
#include <gtest/gtest.h>

#include "ist/query/workers/shared_search.h"
#include "query/contacts/contact_cases.h"
#include "query/scenes.h"
#include "query/workers/shared_query_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

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

// The worker leaves to the caller the chunks whose leaves it has no room for.
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

}  // namespace
}  // namespace ist::test
