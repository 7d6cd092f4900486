// Worlds through the C interface: the answers of C++, and bad values.

#include "ist/query/world/world.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/base/pose.h"
#include "ist/capi/ist_world.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr std::size_t kRoom = 16;

Eigen::Isometry3d isometry(const std::array<double, 16>& pose) {
  Eigen::Isometry3d made;
  std::copy(pose.begin(), pose.end(), made.matrix().data());
  return made;
}

// Four bodies: a ball, a box that it meets, a ball near both, and a plate far away without
// triangles; the same in C and in C++.
class CWorld : public ::testing::Test {
 protected:
  CWorld() {
    auto options = sized<ist_world_options>();
    auto query = sized<ist_query_options>();
    query.frontier_pairs = 1 << 10;
    options.query = &query;
    options.reach = 0.25;
    EXPECT_EQ(name(ist_world_create(&options, &world_)), "ok") << ist_last_error_message();
    WorldOptions same;
    same.query.frontier_pairs = 1 << 10;
    same.reach = 0.25;
    cpp_.emplace(same);
    const TriangleMesh meshes[] = {icosphere(2, 1), box({0, 0, 0}, {2, 2, 2}), icosphere(2, 1),
                                   box({0, 0, 0}, {4, 4, 1})};
    for (std::uint32_t k = 0; k < 4; ++k) {
      const bool triangles = k < 3;
      ist_tree* tree = c_tree(meshes[k], 0.2, triangles);
      std::uint32_t body = 77;
      EXPECT_EQ(name(ist_world_add(world_, tree, poses_[k].data(), names_[k], &body)), "ok");
      EXPECT_EQ(body, k);
      if (k == 0) tree_ = tree;
      if (k > 0) {
        EXPECT_EQ(name(ist_tree_free(tree)), "ok");
      }
      const SphereTree same_tree =
          build_tree(meshes[k], {.voxel_size = 0.2, .keep_triangles = triangles});
      cpp_->add(same_tree, isometry(poses_[k]), names_[k]);
    }
  }
  ~CWorld() override {
    EXPECT_EQ(name(ist_tree_free(tree_)), "ok");
    EXPECT_EQ(name(ist_world_free(world_)), "ok");
  }

  // Asks with room for all pairs.
  ist_status ask(std::int32_t what, const ist_budget* budget = nullptr) {
    question_.ask = what;
    return ist_world_ask(world_, &question_, budget, pairs_, kRoom, &result_);
  }

  const std::array<double, 16> poses_[4] = {c_shift(0, 0, 0), c_shift(0.5, 0, 0),
                                            c_shift(1.9, 0.5, 1), c_shift(0, 50, 0)};
  const char* const names_[4] = {"ball", "box", "other ball", "plate"};
  ist_tree* tree_ = nullptr;
  ist_world* world_ = nullptr;
  std::optional<World> cpp_;
  ist_world_question question_ = sized<ist_world_question>();
  ist_world_pair pairs_[kRoom] = {};
  ist_world_result result_ = sized<ist_world_result>();
};

void expect_same(const ist_world_pair& pair, const WorldPair& expected) {
  EXPECT_EQ(pair.a, expected.bodies.a);
  EXPECT_EQ(pair.b, expected.bodies.b);
}

template <class Result>
void expect_same_points(const Result& result, const NearPair& expected) {
  const Eigen::Vector3d direction = expected.direction();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(result.nearest_fixed[i], expected.fixed_point[i]);
    EXPECT_EQ(result.nearest_moving[i], expected.moving_point[i]);
    EXPECT_EQ(result.direction[i], direction[i]);
  }
  EXPECT_EQ(result.nearest_triangles[0], expected.triangles.fixed);
  EXPECT_EQ(result.nearest_triangles[1], expected.triangles.moving);
}

template <class Result>
double length_of(const Result& result) {
  using Point = Eigen::Map<const Eigen::Vector3d>;
  return (Point(result.nearest_moving) - Point(result.nearest_fixed)).norm();
}

TEST_F(CWorld, GivesTheAnswersOfCpp) {
  std::array<double, 16> rough = poses_[0];
  rough[0] += 1e-4;
  rough[5] -= 1e-4;
  ASSERT_EQ(name(ist_world_set_pose(world_, 0, rough.data())), "ok");
  ASSERT_EQ(cpp_->set_pose(0, isometry(rough)), QueryStatus::kDone);
  std::uint64_t bytes = 0;
  ASSERT_EQ(name(ist_world_bytes_needed(world_, IST_ALL_PAIRS, &bytes)), "ok");
  EXPECT_EQ(bytes, cpp_->bytes_needed());
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  cpp_->reserve();
  auto info = sized<ist_world_info>();
  ASSERT_EQ(name(ist_world_get_info(world_, &info)), "ok");
  EXPECT_EQ(info.bytes, bytes);
  EXPECT_EQ(info.bodies, 4u);

  const auto found = cpp_->ask({WorldQuestion::kIntersects});
  ASSERT_EQ(found.pairs.size(), 3u);
  ASSERT_EQ(name(ask(IST_ASK_INTERSECTS)), "ok");
  EXPECT_EQ(result_.near_pairs, 3u);
  EXPECT_EQ(result_.written, 3u);
  EXPECT_EQ(result_.sphere_tests, found.sphere_tests);
  EXPECT_TRUE(result_.complete == 1 && result_.truncated == 0);
  for (std::size_t k = 0; k < 3; ++k) {
    expect_same(pairs_[k], found.pairs[k]);
    EXPECT_EQ(pairs_[k].status, IST_OK);
    EXPECT_EQ(pairs_[k].answer, static_cast<int>(found.pairs[k].answer));
    EXPECT_EQ(pairs_[k].distance_upper, found.pairs[k].roots.upper);
    EXPECT_EQ(pairs_[k].rotation_error, found.pairs[k].rotation_error);
  }
  EXPECT_EQ(pairs_[0].rotation_error, rotation_error(isometry(rough)));
  EXPECT_GT(pairs_[0].rotation_error, 1e-4);
  EXPECT_EQ(pairs_[0].answer, IST_ANSWER_YES);
  EXPECT_EQ(pairs_[1].answer, IST_ANSWER_NO);

  std::vector<ist_leaf_pair> leaves(1 << 12);
  std::vector<LeafPair> expected(1 << 12);
  const auto listed = cpp_->ask({.kind = WorldQuestion::kLeafPairs, .leaf_pairs = expected});
  question_.leaf_pairs = leaves.data();
  question_.leaf_capacity = leaves.size();
  ASSERT_EQ(name(ask(IST_ASK_LEAF_PAIRS)), "ok");
  std::uint64_t first = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(pairs_[k].found, listed.pairs[k].found);
    EXPECT_EQ(pairs_[k].written, pairs_[k].found);
    EXPECT_EQ(pairs_[k].first, first);
    EXPECT_EQ(pairs_[k].resolution, listed.pairs[k].resolution);
    first += pairs_[k].written;
  }
  ASSERT_GT(first, 10u);
  EXPECT_EQ(std::memcmp(leaves.data(), expected.data(), first * sizeof(LeafPair)), 0);

  std::vector<ist_triangle_pair> triangles(1 << 12);
  std::vector<TrianglePair> meeting(1 << 12);
  const auto met = cpp_->ask({.kind = WorldQuestion::kTrianglePairs, .triangle_pairs = meeting});
  question_.triangles = triangles.data();
  question_.triangle_capacity = triangles.size();
  ASSERT_EQ(name(ask(IST_ASK_TRIANGLE_PAIRS)), "ok");
  ASSERT_GT(pairs_[0].written, 10u);
  EXPECT_EQ(pairs_[0].found, met.pairs[0].found);
  EXPECT_EQ(std::memcmp(triangles.data(), meeting.data(), pairs_[0].found * sizeof(TrianglePair)),
            0);

  const auto apart = cpp_->ask({WorldQuestion::kDistance, 0.01});
  question_.tolerance = 0.01;
  ASSERT_EQ(name(ask(IST_ASK_DISTANCE)), "ok");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(pairs_[k].distance_lower, apart.pairs[k].distance.lower);
    EXPECT_EQ(pairs_[k].distance_upper, apart.pairs[k].distance.upper);
    EXPECT_EQ(pairs_[k].narrowest, apart.pairs[k].narrowest);
    EXPECT_EQ(pairs_[k].complete, 1);
  }

  auto least = sized<ist_least_distance>();
  const WorldDistance nearest = cpp_->distance(0.01);
  ASSERT_EQ(name(ist_world_distance(world_, 0.01, nullptr, &least)), "ok");
  EXPECT_EQ(least.lower, nearest.distance.lower);
  EXPECT_EQ(least.upper, nearest.distance.upper);
  EXPECT_EQ(least.nearest_known, 1);
  EXPECT_EQ(least.a, nearest.nearest->a);
  EXPECT_EQ(least.b, nearest.nearest->b);
  EXPECT_EQ(least.complete, 1);
  EXPECT_EQ(least.pose_missing, 0);
  EXPECT_EQ(name(ist_world_forget(world_)), "ok");
}

TEST_F(CWorld, GivesTheNearestPointsOfCpp) {
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  cpp_->reserve();
  ASSERT_EQ(name(ask(IST_ASK_INTERSECTS)), "ok");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(pairs_[k].nearest_known, 0);
  int meeting = 0, apart = 0;
  for (const double x : {0.0, -1.0, -5.0}) {  // the ball goes away from the others
    ASSERT_EQ(name(ist_world_set_pose(world_, 0, c_shift(x, 0, 0).data())), "ok");
    ASSERT_EQ(cpp_->set_pose(0, isometry(c_shift(x, 0, 0))), QueryStatus::kDone);
    ASSERT_EQ(name(ist_world_forget(world_)), "ok");
    cpp_->forget();
    const auto expected = cpp_->ask({WorldQuestion::kDistance, 0.01});
    question_.tolerance = 0.01;
    ASSERT_EQ(name(ask(IST_ASK_DISTANCE)), "ok");
    ASSERT_EQ(result_.written, expected.pairs.size());
    for (std::size_t k = 0; k < result_.written; ++k) {
      const ist_world_pair& pair = pairs_[k];
      ASSERT_EQ(pair.nearest_known, 1);
      expect_same_points(pair, *expected.pairs[k].nearest);
      EXPECT_GE(length_of(pair), pair.distance_lower - 1e-12);
      EXPECT_LE(length_of(pair), pair.distance_upper + 1e-12);
      const bool intersect = pair.distance_upper == 0;
      (intersect ? meeting : apart) += 1;
      EXPECT_EQ(length_of(pair) == 0, intersect);
      EXPECT_NEAR(Eigen::Map<const Eigen::Vector3d>(pair.direction).norm(), intersect ? 0 : 1,
                  1e-12);
    }
    auto least = sized<ist_least_distance>();
    ASSERT_EQ(name(ist_world_distance(world_, 0.01, nullptr, &least)), "ok");
    ASSERT_EQ(least.points_known, 1);
    EXPECT_GE(length_of(least), least.lower - 1e-12);
    EXPECT_LE(length_of(least), least.upper + 1e-12);
    for (const WorldPair& pair : cpp_->distance(0.01).pairs) {
      if (pair.bodies == BodyPair{least.a, least.b}) expect_same_points(least, *pair.nearest);
    }
  }
  EXPECT_TRUE(meeting > 1 && apart > 1) << meeting << " and " << apart;
  // Roots alone measure no points.
  ASSERT_EQ(name(ist_world_set_pose(world_, 1, c_shift(0, 90, 0).data())), "ok");
  auto least = sized<ist_least_distance>();
  ASSERT_EQ(name(ist_world_distance(world_, 1000, nullptr, &least)), "ok");
  EXPECT_EQ(least.nearest_known, 1);
  EXPECT_EQ(least.points_known, 0);
  EXPECT_EQ(least.direction[0], 0);
}

TEST_F(CWorld, GivesTheContactsOfCpp) {
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  cpp_->reserve();
  const auto felt = cpp_->ask({WorldQuestion::kContacts});
  std::uint64_t count = 0;
  EXPECT_EQ(name(ist_world_get_contacts(world_, 0, 1, nullptr, 0, nullptr, &count)),
            "not-prepared");  // nobody asked
  ASSERT_EQ(name(ask(IST_ASK_CONTACTS)), "ok");
  EXPECT_EQ(pairs_[0].found, felt.pairs[0].found);
  EXPECT_EQ(pairs_[0].contacts, felt.pairs[0].manifold->points().size());
  ist_contact contacts[32];
  auto sums = sized<ist_contact_sums>();
  ASSERT_EQ(name(ist_world_get_contacts(world_, 1, 0, contacts, 2, &sums, &count)), "ok");
  EXPECT_EQ(count, pairs_[0].contacts);
  ASSERT_GT(count, 2u);
  EXPECT_EQ(contacts[1].depth, felt.pairs[0].manifold->points()[1].depth);
  EXPECT_EQ(sums.weight, felt.pairs[0].manifold->sums().weight);
  EXPECT_EQ(sums.spring_force[0], felt.pairs[0].manifold->sums().spring.force[0]);
  EXPECT_EQ(name(ist_world_get_contacts(world_, 0, 3, nullptr, 0, nullptr, &count)),
            "not-prepared");  // it is apart
  EXPECT_EQ(count, 0u);
}

TEST_F(CWorld, TellsThatABudgetEndedTheContactsOfAPair) {
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  std::uint64_t count = 0;
  auto whole = sized<ist_contact_sums>(), part = whole;
  ASSERT_EQ(name(ask(IST_ASK_CONTACTS)), "ok");
  ASSERT_EQ(name(ist_world_get_contacts(world_, 0, 1, nullptr, 0, &whole, &count)), "ok");
  EXPECT_EQ(pairs_[0].complete, 1);
  const auto half = sized<ist_budget>({0, pairs_[0].sphere_tests / 2, 0});
  ASSERT_EQ(name(ask(IST_ASK_CONTACTS, &half)), "ok");
  ASSERT_EQ(name(ist_world_get_contacts(world_, 0, 1, nullptr, 0, &part, &count)), "ok");
  EXPECT_EQ(pairs_[0].complete, 0);
  EXPECT_LT(part.pairs, whole.pairs);
}

TEST_F(CWorld, MovesBodiesAndTellsTheirPoses) {
  ASSERT_EQ(name(ist_world_reserve(world_, IST_ALL_PAIRS)), "ok");
  EXPECT_EQ(name(ist_world_set_pose(world_, 1, c_shift(0, 30, 0).data())), "ok");
  double pose[16];
  ASSERT_EQ(name(ist_world_get_pose(world_, 0, 1, pose)), "ok");
  EXPECT_EQ(pose[13], 30);
  EXPECT_EQ(pose[15], 1);
  ASSERT_EQ(name(ask(IST_ASK_NEAR)), "ok");
  EXPECT_EQ(result_.near_pairs, 1u);
  std::array<double, 16> bad = c_shift(0, 0, 0);
  bad[3] = NAN;
  EXPECT_EQ(name(ist_world_set_pose(world_, 1, bad.data())), "pose-invalid");
  EXPECT_EQ(name(ist_world_get_pose(world_, 0, 1, pose)), "pose-invalid");
  EXPECT_EQ(pose[15], 0);
  ASSERT_EQ(name(ask(IST_ASK_INTERSECTS)), "ok");
  ASSERT_EQ(result_.written, 4u);
  EXPECT_EQ(result_.complete, 0);
  for (std::uint64_t k = 0; k < 4; ++k) {
    const bool of_1 = pairs_[k].a == 1 || pairs_[k].b == 1;
    EXPECT_EQ(pairs_[k].status, of_1 ? IST_POSE_INVALID : IST_OK);
    EXPECT_EQ(pairs_[k].answer == IST_ANSWER_UNKNOWN, of_1);
  }
  auto least = sized<ist_least_distance>();
  ASSERT_EQ(name(ist_world_distance(world_, 0.01, nullptr, &least)), "ok");
  EXPECT_EQ(least.pose_missing, 1);
  EXPECT_EQ(least.complete, 0);
  EXPECT_GT(least.lower, 0);
}

TEST_F(CWorld, ReservesForSomePairs) {
  std::uint64_t one = 0, all = 0;
  ASSERT_EQ(name(ist_world_bytes_needed(world_, 1, &one)), "ok");
  ASSERT_EQ(name(ist_world_bytes_needed(world_, IST_ALL_PAIRS, &all)), "ok");
  EXPECT_LT(one, all);
  EXPECT_EQ(name(ask(IST_ASK_INTERSECTS)), "not-prepared");
  EXPECT_EQ(name(ist_world_ignore(world_, 2, 0)), "ok");
  ASSERT_EQ(name(ist_world_reserve(world_, 1)), "ok");
  auto budget = sized<ist_budget>();
  budget.tests = 1'000'000;
  ASSERT_EQ(name(ask(IST_ASK_INTERSECTS, &budget)), "ok");
  EXPECT_EQ(result_.near_pairs, 2u);
  EXPECT_EQ(result_.written, 1u);
  EXPECT_EQ(result_.truncated, 1);
  EXPECT_EQ(result_.complete, 0);
  EXPECT_EQ(pairs_[0].status, IST_OK);
  // As many as the answer said.
  ASSERT_EQ(name(ist_world_reserve(world_, result_.near_pairs)), "ok");
  ASSERT_EQ(name(ist_world_ask(world_, &question_, &budget, pairs_, 1, &result_)), "ok");
  EXPECT_EQ(result_.written, 1u);
  EXPECT_EQ(result_.truncated, 1);
  EXPECT_EQ(result_.complete, 1);
}

TEST_F(CWorld, TellsWhatIsMisused) {
  const auto expect = [](ist_status status, const char* code, const char* part) {
    EXPECT_EQ(name(status), code);
    EXPECT_NE(std::strstr(ist_last_error_message(), part), nullptr) << ist_last_error_message();
  };
  auto options = sized<ist_world_options>();
  ist_world* none = nullptr;
  options.reach = -1;
  expect(ist_world_create(&options, &none), "argument-invalid", "reach");
  options = sized<ist_world_options>();
  auto query = sized<ist_query_options>();
  options.query = &query;
  query.workers = 2;
  expect(ist_world_create(&options, &none), "argument-invalid", "workers is 2");
  query.workers = 1;
  for (const std::int32_t threads : {-1, IST_MOST_THREADS + 1}) {
    options.threads = threads;
    expect(ist_world_create(&options, &none), "argument-invalid", "threads is");
  }
  options.threads = 0;
  query.workers = 5;
  expect(ist_world_create(&options, &none), "argument-invalid", "workers is 5");
  options.struct_size = 9;
  expect(ist_world_create(&options, &none), "struct-size", "struct_size");
  std::uint32_t body = 0;
  std::array<double, 16> bad = c_shift(0, 0, 0);
  bad[0] = 3;
  expect(ist_world_add(world_, tree_, bad.data(), "bent", &body), "pose-invalid", "'bent'");
  expect(ist_world_ignore(world_, 0, 4), "argument-invalid", "body 4");
  expect(ist_world_set_pose(world_, 4, c_shift(0, 0, 0).data()), "argument-invalid", "number");
  double pose[16];
  expect(ist_world_get_pose(world_, 4, 0, pose), "argument-invalid", "number");
  question_.tolerance = -1;
  expect(ask(IST_ASK_DISTANCE), "argument-invalid", "question->tolerance is -1");
  question_.tolerance = 0;
  for (const std::int32_t what : {-1, 3, int{IST_ASK_PENETRATION}, 64}) {
    expect(ask(what), "argument-invalid", "question->ask");
  }
  question_.leaf_capacity = 1;
  expect(ask(IST_ASK_LEAF_PAIRS), "null-argument", "question->leaf_pairs is NULL");
  question_.leaf_capacity = 0;
  question_.triangle_capacity = 1;
  expect(ask(IST_ASK_TRIANGLE_PAIRS), "null-argument", "question->triangles is NULL");
  question_.struct_size = 9;
  expect(ask(IST_ASK_NEAR), "struct-size", "question->struct_size");
  options = sized<ist_world_options>();
  options.max_memory = 1'000'000;
  ASSERT_EQ(name(ist_world_create(&options, &none)), "ok");
  for (const char* const each : {"first", "second"}) {
    ASSERT_EQ(name(ist_world_add(none, tree_, nullptr, each, &body)), "ok");
  }
  expect(ist_world_reserve(none, IST_ALL_PAIRS), "memory-limit", "1 near pair");
  EXPECT_EQ(name(ist_world_free(none)), "ok");
}

}  // namespace
}  // namespace ist::test
