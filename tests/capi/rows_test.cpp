// Rows of many poses: what the single calls say, bit by bit, for any number of threads.

#include <gtest/gtest.h>

#include <cmath>
#include <condition_variable>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "c_bodies.h"
#include "ist/base/parallel.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/pose_rows.h"
#include "listener.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kTolerance = 1e-3, kStiffness = 2.5;

std::uint64_t bits(double value) {
  std::uint64_t word;
  std::memcpy(&word, &value, sizeof(word));
  return word;
}

class CRows : public ::testing::Test {
 protected:
  CRows() {
    EXPECT_EQ(name(ist_query_create(fixed_, moving_, nullptr, &query_)), "ok");
    options_.questions = IST_ASK_INTERSECTS | IST_ASK_LEAF_PAIRS | IST_ASK_DISTANCE |
                         IST_ASK_CONTACTS | IST_ASK_PENETRATION;
    options_.tolerance = kTolerance;
    options_.stiffness = kStiffness;
  }
  ~CRows() override {
    EXPECT_EQ(name(ist_query_free(query_)), "ok");
    EXPECT_EQ(name(ist_tree_free(fixed_)), "ok");
    EXPECT_EQ(name(ist_tree_free(moving_)), "ok");
  }

  // Poses that turn: apart, in contact, one body in the other, and every tenth is no motion.
  static std::vector<double> poses(std::size_t count) {
    Random random(7);
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Isometry3d pose(
          Eigen::AngleAxisd(random.uniform(-3, 3), random.direction()).toRotationMatrix());
      pose.translation() = random.uniform(0, 8) * random.direction();
      if (i % 10 == 9) pose.matrix()(0, 0) = i % 20 == 9 ? 3 : std::nan("");
      all.insert(all.end(), pose.matrix().data(), pose.matrix().data() + 16);
    }
    return all;
  }

  std::vector<ist_row> rows(const std::vector<double>& poses, std::int32_t threads) {
    std::vector<ist_row> found(poses.size() / 16);
    options_.threads = threads;
    EXPECT_EQ(name(ist_query_rows(query_, poses.data(), found.size(), &options_, found.data())),
              "ok")
        << ist_last_error_message();
    return found;
  }

  ist_tree* fixed_ = c_tree(icosphere(3, 4), 0.5);
  ist_tree* moving_ = c_tree(box({-1, -2, -3}, {1, 2, 3}), 0.4);
  ist_query* query_ = nullptr;
  ist_rows_options options_ = sized<ist_rows_options>();
};

TEST_F(CRows, AreTheSingleCallsBitByBit) {
  const std::vector<double> at = poses(60);
  const std::vector<ist_row> found = rows(at, 2);
  int touching = 0, apart = 0, inside = 0, invalid = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const ist_row& row = found[i];
    const double* pose = at.data() + 16 * i;
    const auto fresh = [&] { EXPECT_EQ(name(ist_query_forget(query_)), "ok"); };
    fresh();
    std::int32_t answer = 0;
    const ist_status status = ist_query_intersects(query_, pose, nullptr, &answer);
    EXPECT_EQ(row.status, status);
    EXPECT_EQ(row.intersects, answer);
    if (status != IST_OK) {
      EXPECT_EQ(status, IST_POSE_INVALID);
      for (const double number :
           {row.distance_lower, row.depth_upper, row.area, row.force[0], row.torque[2]}) {
        EXPECT_TRUE(std::isnan(number));
      }
      EXPECT_EQ(row.leaf_pairs, 0U);
      ++invalid;
      continue;
    }
    fresh();
    auto listed = sized<ist_query_result>();
    EXPECT_EQ(name(ist_query_leaf_pairs(query_, pose, nullptr, nullptr, 0, &listed)), "ok");
    EXPECT_EQ(row.leaf_pairs, listed.leaf_pairs);
    fresh();
    auto distance = sized<ist_distance_result>();
    EXPECT_EQ(name(ist_query_distance(query_, pose, kTolerance, nullptr, &distance)), "ok");
    EXPECT_EQ(bits(row.distance_lower), bits(distance.lower));
    EXPECT_EQ(bits(row.distance_upper), bits(distance.upper));
    fresh();
    auto sums = sized<ist_contact_sums>();
    auto felt = sized<ist_query_result>();
    EXPECT_EQ(name(ist_query_contacts(query_, pose, nullptr, nullptr, 0, &sums, &felt)), "ok");
    double force[3], torque[3];
    EXPECT_EQ(name(ist_contact_sums_wrench(&sums, kStiffness, force, torque)), "ok");
    EXPECT_EQ(bits(row.area), bits(sums.weight));
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(bits(row.force[k]), bits(force[k]));
      EXPECT_EQ(bits(row.torque[k]), bits(torque[k]));
    }
    fresh();
    auto depth = sized<ist_penetration>();
    EXPECT_EQ(
        name(ist_query_penetration(query_, pose, kTolerance, nullptr, nullptr, nullptr, &depth)),
        "ok");
    EXPECT_EQ(bits(row.depth_lower), bits(depth.lower));
    EXPECT_EQ(bits(row.depth_upper), bits(depth.upper));
    EXPECT_EQ(row.complete, distance.complete && depth.complete);
    touching += answer == IST_ANSWER_YES;
    apart += answer == IST_ANSWER_NO && depth.upper == 0;
    inside += answer == IST_ANSWER_NO && depth.lower > 0;
  }
  EXPECT_GE(touching, 5);
  EXPECT_GE(apart, 5);
  EXPECT_GE(inside, 1);
  EXPECT_EQ(invalid, 6);
}

TEST_F(CRows, AreTheSameForAnyNumberOfThreadsThread) {
  const std::vector<double> at = poses(200);
  const std::vector<ist_row> one = rows(at, 1);
  for (const std::int32_t threads : {2, 3, 8, 0}) {
    const std::vector<ist_row> many = rows(at, threads);
    EXPECT_EQ(std::memcmp(many.data(), one.data(), one.size() * sizeof(ist_row)), 0) << threads;
  }
}

TEST_F(CRows, DoNotDependOnWhatElseIsAsked) {
  const std::vector<double> at = poses(40);
  const std::vector<ist_row> all = rows(at, 2);
  options_.questions = IST_ASK_DISTANCE;
  const std::vector<ist_row> alone = rows(at, 2);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(bits(alone[i].distance_lower), bits(all[i].distance_lower));
    EXPECT_EQ(bits(alone[i].distance_upper), bits(all[i].distance_upper));
    EXPECT_EQ(alone[i].intersects, IST_ANSWER_UNKNOWN);
    EXPECT_EQ(alone[i].leaf_pairs, 0U);
    EXPECT_TRUE(std::isnan(alone[i].depth_lower) && std::isnan(alone[i].area));
  }
}

TEST_F(CRows, KeepALimitOfTests) {
  const std::vector<double> at = poses(20);
  options_.questions = IST_ASK_LEAF_PAIRS;
  options_.tests = 5;
  int stopped = 0;
  for (const ist_row& row : rows(at, 2)) {
    EXPECT_LE(row.sphere_tests, 6U);
    stopped += row.status == IST_OK && row.complete == 0;
  }
  EXPECT_GE(stopped, 5);
}

// The thread that gives the first row waits until another one gives a row.
TEST_F(CRows, AreSharedByThreadsHoweverLongAPoseTakesThread) {
  const SphereTree tree = build_tree(icosphere(1, 2), {.voxel_size = 0.5});
  Query query(tree, tree);
  const std::vector<Eigen::Isometry3d> at(40, Eigen::Isometry3d::Identity());
  std::mutex mutex;
  std::condition_variable another;
  std::map<std::thread::id, int> given;
  EXPECT_TRUE(
      answer_rows({query, {}, {}}, at, {.intersects = true}, 0, [&](std::size_t, const PoseRow&) {
        std::unique_lock lock(mutex);
        ++given[std::this_thread::get_id()];
        another.notify_all();
        another.wait(lock, [&] { return given.size() > 1 || thread_count() == 1; });
      }));
  int all = 0;
  for (const auto& [thread, count] : given) all += count;
  EXPECT_EQ(all, 40);
}

TEST_F(CRows, OfNoPosesAreNone) {
  EXPECT_EQ(name(ist_query_rows(query_, nullptr, 0, &options_, nullptr)), "ok");
}

TEST_F(CRows, EndWhereTheCallerSaysSoAndLeaveTheArray) {
  const std::vector<double> at = poses(50);
  std::vector<ist_row> found(50);
  found[0].leaf_pairs = 77;
  struct Caller {
    int reports = 0;
    double last = -1;
  } caller;
  const auto progress = sized<ist_progress>({0,
                                             [](void* user, double part) {
                                               auto& told = *static_cast<Caller*>(user);
                                               EXPECT_GE(part, told.last);
                                               told.last = part;
                                               return ++told.reports == 1 ? 1 : 0;
                                             },
                                             &caller});
  options_.progress = &progress;
  EXPECT_EQ(name(ist_query_rows(query_, at.data(), 50, &options_, found.data())), "cancelled");
  EXPECT_EQ(caller.reports, 1);
  EXPECT_EQ(found[0].leaf_pairs, 77U);
  caller.reports = 5;
  caller.last = -1;
  EXPECT_EQ(name(ist_query_rows(query_, at.data(), 50, &options_, found.data())), "ok");
  EXPECT_GE(caller.reports, 6);
  EXPECT_NE(found[0].leaf_pairs, 77U);
}

TEST_F(CRows, EndMidwayToo) {
  std::vector<ist_row> found, before;
  expect_ends_midway([&](std::size_t work, const ist_progress* progress) {
    const std::vector<double> at = poses(400 * work);
    options_.progress = progress;
    before.assign(400 * work, {});
    before.front().leaf_pairs = before.back().leaf_pairs = 77;
    found = before;
    return ist_query_rows(query_, at.data(), found.size(), &options_, found.data());
  });
  EXPECT_EQ(std::memcmp(found.data(), before.data(), found.size() * sizeof(ist_row)), 0);
}

TEST_F(CRows, OfBadOptionsAreRefused) {
  const std::vector<double> at = poses(1);
  ist_row row{};
  const auto status = [&](auto change) {
    auto options = options_;
    change(options);
    return name(ist_query_rows(query_, at.data(), 1, &options, &row));
  };
  EXPECT_EQ(status([](auto& o) { o.questions = 0; }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.questions = 32; }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.threads = -1; }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.threads = 1025; }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.tolerance = -1; }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.tolerance = std::nan(""); }), "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.stiffness = std::numeric_limits<double>::infinity(); }),
            "argument-invalid");
  EXPECT_EQ(status([](auto& o) { o.struct_size = 3; }), "struct-size");
  EXPECT_EQ(name(ist_query_rows(query_, at.data(), SIZE_MAX / 8, &options_, &row)),
            "argument-invalid");

  auto without = sized<ist_query_options>();
  without.contacts = -1;
  ist_query* query = nullptr;
  ASSERT_EQ(name(ist_query_create(fixed_, moving_, &without, &query)), "ok");
  EXPECT_EQ(name(ist_query_rows(query, at.data(), 1, &options_, &row)), "not-prepared");
  EXPECT_EQ(name(ist_query_free(query)), "ok");

  ist_tree* bare = c_tree(icosphere(2, 3), 0.5, false);
  ASSERT_EQ(name(ist_query_create(bare, moving_, nullptr, &query)), "ok");
  EXPECT_EQ(name(ist_query_rows(query, at.data(), 1, &options_, &row)), "triangles-missing");
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(bare)), "ok");
}

}  // namespace
}  // namespace ist::test
