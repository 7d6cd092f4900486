#include "advise/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ist/models/models.h"
#include "query/exact/exact_tree.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// A sphere of radius 2 above the middle of a box, its lowest vertex at z = 0.5 over the top: how
// far the surfaces are apart is told by where it is alone.
class SphereOnBox : public ::testing::Test {
 protected:
  static constexpr double kHeight = 0.5;

  [[nodiscard]] static TriangleMesh sphere() {
    TriangleMesh mesh = icosphere(4, 2);
    const double lowest = std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                                           [](const auto& a, const auto& b) { return a[2] < b[2]; })
                              ->z();
    return moved(std::move(mesh), {0.0123, -0.0171, kHeight - lowest});
  }

  [[nodiscard]] ClosingPath path() {
    const auto found = find_closing_path(bodies_, {2, +1});
    EXPECT_TRUE(found);
    EXPECT_NEAR(found->first_contact, -kHeight, found->accuracy);
    return *found;
  }

  // The largest distance at which voxels touch, in small steps from far away. By the scalar form of
  // the engine that is measured: the published query differs in pairs that do not meet.
  [[nodiscard]] static double swept_error(double voxel_size) {
    const SphereTree fixed = tree_with_triangles(block(), voxel_size);
    const SphereTree moving = tree_with_triangles(sphere(), voxel_size);
    QueryOptions options;
    options.target = "scalar";
    Query query(fixed, moving, options);
    for (double distance = 4 * voxel_size; distance > 0; distance -= step(voxel_size)) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation()[2] = distance - kHeight;
      if (query.leaf_pairs(pose, std::span<LeafPair>{}).leaf_pairs > 0) return distance;
    }
    return 0;
  }
  [[nodiscard]] static double step(double voxel_size) { return voxel_size / 300; }

  [[nodiscard]] static TriangleMesh block() { return box({-3, -3, -1.1}, {3, 3, 0}); }

  const SphereTree fixed_ = exact_tree(block(), 20), moving_ = exact_tree(sphere(), 20);
  ExactBodies bodies_{fixed_, moving_};
  // Times do not matter to most tests.
  const CalibrationOptions options_{
      .target = "", .rounds = 5, .time = std::chrono::milliseconds(1)};
};

TEST_F(SphereOnBox, MeasuresTheErrorOfAClosing) {
  Calibration calibration(bodies_, path(), options_);
  EXPECT_EQ(calibration.poses().size(), kClosingPoses);
  for (const double voxel_size : {0.4, 0.17, 0.1}) {
    SCOPED_TRACE(voxel_size);
    const std::optional<SizeMeasure> measured = calibration.measure(voxel_size);
    ASSERT_TRUE(measured);
    // On inclined ways it may be a little more.
    const double straight = swept_error(voxel_size);
    EXPECT_GE(measured->error, straight - 2 * step(voxel_size));
    EXPECT_LE(measured->error, 1.1 * straight);
    EXPECT_GT(measured->error, 0);
    EXPECT_LE(measured->error, measured->resolution);
    EXPECT_EQ(measured->voxel_size, voxel_size);
    EXPECT_GT(measured->bytes, 0u);
  }
}

// The largest error of all ways, of which one that is inclined is the worst here.
TEST_F(SphereOnBox, MeasuresTheWaysBeside) {
  constexpr double kSize = 0.17;
  const ClosingPath straight = path();
  const std::vector<ClosingPath> beside = paths_beside(bodies_, straight);
  ASSERT_EQ(beside.size(), 6u);
  const SphereTree fixed = tree_with_triangles(block(), kSize);
  const SphereTree moving = tree_with_triangles(sphere(), kSize);
  Query query(fixed, moving);
  const double serial = closing_error(bodies_, query, kSize, straight);
  double largest = serial;
  for (const ClosingPath& way : beside) {
    largest = std::max(largest, closing_error(bodies_, query, kSize, way));
  }
  EXPECT_GT(largest, serial);
  EXPECT_EQ(Calibration(bodies_, straight, options_).measure(kSize)->error, largest);
}

// A clock for a calibration. It reads the clock for the build, for the end of the rounds, and then
// before and after each query; each reading comes at a time of the test's choice.
struct ScriptedClock {
  static Budget::Clock::time_point now() noexcept {
    const std::size_t at = readings++;
    if (at == 1) return time += kBuild;
    if (at >= 3 && at % 2 == 0) time += query_time((at - 4) / 2);
    return time;
  }
  // The time of a query, by its number. In each round the poses take 101, 102 ... microseconds; in
  // the second all take 1 ms more, in the fourth 50 less, and in the last pose 3 takes the longest.
  static std::chrono::microseconds query_time(std::size_t query) {
    const std::size_t round = query / kClosingPoses, pose = query % kClosingPoses;
    const int usual = 101 + static_cast<int>(pose);
    return std::chrono::microseconds(round == 1                ? usual + 1000
                                     : round == 3              ? usual - 50
                                     : round >= 4 && pose == 3 ? 5000
                                                               : usual);
  }
  static constexpr std::chrono::milliseconds kBuild{250};
  static inline std::size_t readings;
  static inline Budget::Clock::time_point time;
};

// The median of a pose's times, at the slowest pose; no time of another round counts.
TEST_F(SphereOnBox, MeasuresTheSlowestPose) {
  CalibrationOptions options = options_;
  options.now = ScriptedClock::now;
  Calibration calibration(bodies_, path(), options);
  ScriptedClock::readings = 0;
  const SizeMeasure measured = *calibration.measure(0.1);
  EXPECT_EQ(ScriptedClock::readings, 3 + 2 * 5 * kClosingPoses);
  EXPECT_DOUBLE_EQ(measured.build_milliseconds, 250);
  // Pose 3 takes 104, 1104, 104, 54 and 5000. Pose 11 takes 112, 1112, 112, 62 and 112.
  EXPECT_DOUBLE_EQ(measured.slowest_query, 112);

  const SphereTree fixed = tree_with_triangles(block(), 0.1);
  const SphereTree moving = tree_with_triangles(sphere(), 0.1);
  Query query(fixed, moving);
  std::uint64_t most = 0;
  std::vector<LeafPair> leaf_pairs(1 << 16);
  for (const Eigen::Isometry3d& pose : calibration.poses()) {
    most = std::max(most, query.leaf_pairs(pose, leaf_pairs).leaf_pairs);
  }
  EXPECT_EQ(measured.max_leaf_pairs, most);
  EXPECT_GT(most, 0u);

  // The rounds end with their time, but not before the fifth.
  options.rounds = 300;
  options.time = std::chrono::milliseconds(20);  // five rounds take more
  ScriptedClock::readings = 0;
  EXPECT_DOUBLE_EQ(Calibration(bodies_, path(), options).measure(0.1)->slowest_query, 112);
  EXPECT_EQ(ScriptedClock::readings, 3 + 2 * 5 * kClosingPoses + 1);
  options.time = std::chrono::milliseconds(30);
  ScriptedClock::readings = 0;
  static_cast<void>(Calibration(bodies_, path(), options).measure(0.1));
  EXPECT_GT(ScriptedClock::readings, 3 + 2 * 6 * kClosingPoses);
  EXPECT_LT(ScriptedClock::readings, 3 + 2 * 20 * kClosingPoses);
}

// Jaws come up to each other in other ways than the one that is measured.
TEST(CalibrationOfJaws, HoldsOnOtherWays) {
  IST_SLOW();
  const SphereTree upper = exact_tree(make_jaw(Jaw::kUpper, 1), 100);
  const SphereTree lower = exact_tree(make_jaw(Jaw::kLower, 1), 100);
  ExactBodies bodies(upper, lower);
  const auto path =
      find_closing_path(bodies, shortest_open_direction(bodies.fixed_box(), bodies.moving_box()));
  ASSERT_TRUE(path);
  Calibration calibration(bodies, *path, {.target = "", .rounds = 5, .time = {}});
  const double size = 0.8, error = calibration.measure(size)->error;

  const SphereTree fixed = tree_with_triangles(bodies.fixed(), size);
  const SphereTree moving = tree_with_triangles(bodies.moving(), size);
  Query query(fixed, moving);
  Random random(5);
  double largest = 0;
  int ways = 0;
  for (int i = 0; i < 12; ++i) {
    ClosingPath way = *path;
    way.open_direction = (path->open_direction + random.point(-0.3, 0.3)).normalized();
    const Eigen::Vector3d half = random.point(-0.02, 0.02);
    way.turn = Eigen::Quaterniond(1, half[0], half[1], half[2]).normalized().toRotationMatrix();
    way.about = bodies.moving_box().center();
    double offset = path->begin;
    while (offset < 10 &&
           query.leaf_pairs(way.pose(offset), std::span<LeafPair>{}).leaf_pairs > 0) {
      offset += size / 50;
    }
    while (query.leaf_pairs(way.pose(offset), std::span<LeafPair>{}).leaf_pairs == 0)
      offset -= size / 50;
    ++ways;
    largest = std::max(largest, bodies.distance(way.pose(offset), 1e-3).upper);
  }
  EXPECT_EQ(ways, 12);
  // What is measured is of seven ways, so others may come to a little more, and hardly to less.
  EXPECT_LE(largest, 1.15 * error);
  EXPECT_GE(largest, 0.6 * error);
}

TEST_F(SphereOnBox, RecommendsTheLargestVoxelsThatKeepAnError) {
  Calibration calibration(bodies_, path(), options_);
  for (const double error : {0.05, 0.12}) {
    SCOPED_TRACE(error);
    const VoxelAdvice advice =
        advise_voxel_size({AdviceGoal::Of::kError, error}, {1e-3, 0.5, 2},
                          [&](double voxel_size) { return calibration.measure(voxel_size); });
    ASSERT_TRUE(advice.recommended);
    const double size = advice.measured[*advice.recommended].voxel_size;
    EXPECT_LE(swept_error(size), error + 2 * step(size));
    EXPECT_GT(swept_error(2 * size), error);
    EXPECT_LE(advice.measured.size(), 8u);
  }
}

TEST_F(SphereOnBox, MeasuresTheErrorAtPoses) {
  const auto at = [&](double distance) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation()[2] = distance - kHeight;
    return pose;
  };
  const auto error = [&](const std::vector<Eigen::Isometry3d>& poses) {
    Calibration calibration(bodies_, poses, options_);
    return calibration.measure(0.4)->error;
  };
  const double first = swept_error(0.4);
  ASSERT_GT(first, 0.05);
  EXPECT_NEAR(error({at(0.5 * first)}), 0.5 * first, 1e-6);
  EXPECT_EQ(error({at(4)}), 0);
  EXPECT_EQ(error({at(-0.1)}), 0);
  // Between neighbours, either way round.
  EXPECT_NEAR(error({at(4), at(-0.1)}), first, 2 * step(0.4));
  EXPECT_NEAR(error({at(-0.1), at(4)}), first, 2 * step(0.4));
  // But not where one is turned: the way between is not known.
  Eigen::Isometry3d turned = at(4);
  turned.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(error({turned, at(-0.1)}), 0);
}

// Nothing is measured exactly where no tree can be built.
TEST_F(SphereOnBox, SizesThatCannotBeBuilt) {
  IST_SLOW();
  CalibrationOptions options = options_;
  options.max_memory = 1 << 20;
  Calibration calibration(bodies_, path(), options);
  bool fits = false, does_not = false;
  for (const double voxel_size : {0.4, 0.2, 0.1, 0.05, 0.02, 1e-3, 1e-9, -1.0, 0.0}) {
    SCOPED_TRACE(voxel_size);
    bool builds = true;
    for (const SpherePolicy spheres : {SpherePolicy::kSlab, SpherePolicy::kTable}) {
      for (const bool keep_triangles : {false, true}) {
        BuildOptions build;
        build.voxel_size = voxel_size;
        build.spheres = spheres;
        build.keep_triangles = keep_triangles;
        build.max_memory = options.max_memory;
        for (const TriangleMesh& mesh : {block(), sphere()}) {
          const bool can = can_build_tree(mesh, build);
          EXPECT_EQ(can, !error_of([&] { static_cast<void>(build_tree(mesh, build)); }));
          if (spheres == SpherePolicy::kSlab && !keep_triangles) builds = builds && can;
        }
      }
    }
    EXPECT_EQ(calibration.measure(voxel_size).has_value(), builds);
    (builds ? fits : does_not) = true;
  }
  EXPECT_TRUE(fits && does_not);
}

TEST_F(SphereOnBox, TargetsThatAreNotThere) {
  CalibrationOptions options = options_;
  options.target = "none";
  Calibration calibration(bodies_, path(), options);
  EXPECT_EQ(error_name([&] { static_cast<void>(calibration.measure(0.4)); }), "target-missing");
}

}  // namespace
}  // namespace ist::test
