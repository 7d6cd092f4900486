// Bad input in the middle of a sequence of poses, and two threads in one query.

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>
#include <vector>

#include "query/every_verb.h"
#include "query/pair_cache/kept_answers.h"
#include "query/triangles/triangle_tree.h"
#include "support/errors.h"

namespace ist::test {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

QueryOptions keeping(SpherePolicy policy, int workers = 1) {
  QueryOptions options = options_of(policy, "", workers);
  options.front_pairs = 1 << 15;
  return options;
}

TEST(CoherentMisuse, OfAPoseIsAStatusAndTheNextTickIsRight) {
  const Scene& scene = solids()[0];
  for (const int workers : {1, 2}) {
    KeptAnswers answers(scene, keeping(SpherePolicy::kSlab, workers));
    std::vector<Eigen::Isometry3d> bad(4, scene.pose);
    bad[0].translation()[1] = kNotANumber;
    bad[1].linear() *= 2;
    bad[2].linear()(0, 0) = kNotANumber;
    bad[3].translation()[2] = HUGE_VAL;
    Eigen::Isometry3d pose = scene.pose;
    ContactManifold points(scene.fixed, scene.moving, SpherePolicy::kSlab, {.margin = 2});
    for (int i = 0; i < 80; ++i) {
      pose.translation()[2] += 0.005 * scene.fixed.voxel_size();
      if (i % 5 == 4) {
        const Eigen::Isometry3d& wrong = bad[static_cast<std::size_t>(i / 5) % bad.size()];
        const QueryResult listed = answers.kept().leaf_pairs(wrong, std::span<LeafPair>());
        const QueryResult touched = answers.kept().contacts(wrong, points);
        for (const QueryResult& result : {listed, touched}) {
          EXPECT_EQ(result.status, QueryStatus::kInvalidPose);
          EXPECT_FALSE(result.complete);
          EXPECT_EQ(result.leaf_pairs, 0u);
        }
      }
      const QueryResult result = answers.check_contacts(pose);
      if (HasFailure()) return;
      // What was kept is not lost by it.
      EXPECT_TRUE(workers == 2 || i <= 30 || result.found == Found::kKept) << i;
    }
  }
}

TEST(CoherentMisuse, OfAManifoldIsAStatusAndTheNextTickIsRight) {
  const Scene &scene = solids()[0], &other = solids()[1];
  KeptAnswers answers(scene, keeping(SpherePolicy::kSlab));
  ContactManifold wrong(other.fixed, other.moving, SpherePolicy::kSlab, {.margin = 2}),
      loose(scene.fixed, scene.moving, SpherePolicy::kTight, {.margin = 2});
  for (int i = 0; i < 40; ++i) {
    answers.check_contacts(scene.pose);
    for (ContactManifold* each : {&wrong, &loose}) {
      const QueryResult result = answers.kept().contacts(scene.pose, *each);
      EXPECT_EQ(result.status, QueryStatus::kManifoldMismatch);
      EXPECT_TRUE(each->points().empty());
    }
  }
  EXPECT_GT(answers.counts().kept, 20u);
}

TEST(CoherentMisuse, OfMemoryThrows) {
  const Scene& scene = solids()[1];
  for (const std::size_t many : {kMostItems + 1, std::numeric_limits<std::size_t>::max()}) {
    QueryOptions options;
    options.front_pairs = many;
    const auto error = error_of([&] { Query(scene.fixed, scene.moving, options); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    EXPECT_NE(std::string(error->what()).find("front_pairs"), std::string::npos) << error->what();
  }
}

// Stays in take() until it is let go.
class BlockingStream final : public LeafPairStream {
 public:
  bool take(std::span<const LeafPair> pairs) noexcept override {
    count += pairs.size();
    inside = true;
    inside.notify_all();
    released.wait(false);
    return true;
  }
  std::atomic<bool> inside{false}, released{false};
  std::uint64_t count = 0;
};

class TwoThreads : public ::testing::Test {
 protected:
  const SphereTree ball_ = triangle_tree(icosphere(3, 1), 20);
  const Eigen::Isometry3d pose_ = shift({1.9, 0, 0});
};

TEST_F(TwoThreads, InOneQueryTheSecondIsToldThatItIsBusy) {
  for (const std::size_t front_pairs : {std::size_t{0}, std::size_t{1} << 15}) {
    QueryOptions options;
    options.front_pairs = front_pairs;
    Query query(ball_, ball_, options);
    VerbRoom room(query, {.margin = 2});
    ContactManifold& points = room.manifold;
    QueryResult before;
    for (int i = 0; i < 20; ++i) before = query.contacts(pose_, points);
    ASSERT_FALSE(points.points().empty());
    EXPECT_EQ(before.found, front_pairs > 0 ? Found::kKept : Found::kFresh);
    const ContactSums sums = points.sums();
    const std::size_t contacts = points.points().size();
    BlockingStream stream;
    QueryResult streamed;
    std::thread first([&] { streamed = query.leaf_pairs(pose_, stream); });
    stream.inside.wait(false);
    const auto let_go = [&] {
      stream.released = true;
      stream.released.notify_all();
      first.join();
    };
    // At a pose that is no motion, so that a query that is entered all the same suffers no harm.
    Eigen::Isometry3d no_pose = pose_;
    no_pose.translation()[0] = kNotANumber;
    if (query.leaf_pairs(no_pose, std::span<LeafPair>()).status != QueryStatus::kBusy) {
      let_go();
      FAIL() << "two threads are in one query";
    }
    const std::vector<LeafPair> sevens(room.leaf_pairs.size(), LeafPair{7, 7});
    room.leaf_pairs = sevens;
    PairCollector none;
    const auto expect_busy = [](const auto& result) {
      EXPECT_EQ(result.status, QueryStatus::kBusy);
      EXPECT_FALSE(result.complete);
    };
    for (const Budget& budget : {Budget{}, Budget{.tests = 10}}) {
      ask_every_verb(query, pose_, room, budget, expect_busy);
    }
    expect_busy(query.leaf_pairs(pose_, none));
    EXPECT_EQ(query.intersects(pose_).answer, ist::Answer::kUnknown);
    EXPECT_STREQ(to_string(QueryStatus::kBusy), "busy");
    // Nothing was changed.
    EXPECT_TRUE(none.pairs.empty());
    EXPECT_EQ(room.leaf_pairs, sevens);
    EXPECT_TRUE(same(points.sums(), sums));
    EXPECT_EQ(points.points().size(), contacts);
    let_go();
    EXPECT_EQ(streamed.status, QueryStatus::kDone);
    EXPECT_EQ(streamed.leaf_pairs, before.leaf_pairs);
    EXPECT_EQ(stream.count, before.leaf_pairs);
    EXPECT_EQ(query.contacts(pose_, points).leaf_pairs, before.leaf_pairs);
    EXPECT_TRUE(same(points.sums(), sums));
  }
}

// At any moment: an answer is right, or the query is busy.
TEST_F(TwoThreads, InOneQueryAreRightOrBusy) {
  for (const int workers : {1, 2}) {
    QueryOptions options;
    options.workers = workers;
    options.period = std::chrono::nanoseconds(0);
    Query single(ball_, ball_);
    options.front_pairs = 1 << 15;
    Query query(ball_, ball_, options);
    std::vector<Eigen::Isometry3d> poses;
    std::vector<FoundContacts> expected;
    ContactManifold points(ball_, ball_, single.policy(), {.margin = 2});
    for (int i = 0; i < 30; ++i) {
      poses.push_back(shift({1.9 + 0.0004 * i, 0, 0}));
      expected.push_back(find_contacts(single, points, poses.back()));
    }
    std::atomic<int> wrong{0}, right{0};
    const auto ask_all = [&](std::size_t from) {
      ContactManifold own(ball_, ball_, single.policy(), {.margin = 2});
      std::size_t answers = 0;
      for (std::size_t i = 0; answers < 500; ++i) {
        const std::size_t k = (from + i) % poses.size();
        const FoundContacts found = find_contacts(query, own, poses[k]);
        if (found.result.status == QueryStatus::kBusy) continue;
        ++answers;
        ++(same(found, expected[k]) ? right : wrong);
      }
    };
    std::thread other(ask_all, 15);
    ask_all(0);
    other.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(right, 1000);
  }
}

}  // namespace
}  // namespace ist::test
