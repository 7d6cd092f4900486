#include "ist/query/pair_cache/pose_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr std::size_t kTicks = PoseTrack::kTicks;

RelativePose pose_at(double angle, const Eigen::Vector3d& translation,
                     const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), translation};
}

class PoseTracks : public ::testing::Test {
 protected:
  const SphereTree tree_ = tree_of(icosphere(2, 1), 12);
  const MotionBound bound_{tree_, tree_, SpherePolicy::kSlab};
  void add(const RelativePose& pose) { track_.add(pose, bound_, 0.1); }

  PoseTrack track_;
};

TEST_F(PoseTracks, KnowNothingOfOnePose) {
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  EXPECT_EQ(track_.drift(bound_, 0.1), HUGE_VAL);
  add(pose_at(0.3, {1, 0.5, 0}));
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  EXPECT_EQ(track_.drift(bound_, 0.1), HUGE_VAL);
  EXPECT_TRUE(track_.ahead(5).rotation.isApprox(pose_at(0.3, {0, 0, 0}).rotation, 1e-12));
  EXPECT_EQ(track_.ahead(5).translation, Eigen::Vector3d(1, 0.5, 0));
}

TEST_F(PoseTracks, GoStraightOn) {
  const Eigen::Vector3d step(0.001, -0.002, 0.0005);
  for (std::size_t i = 0; i < 40; ++i) {
    const Eigen::Vector3d at = static_cast<double>(i) * step;
    add(pose_at(0, at));
    if (i == 0) continue;
    EXPECT_NEAR(track_.speed(), step.norm(), 1e-12);
    EXPECT_NEAR(track_.drift(bound_, 0.1), step.norm(), 1e-12);
    for (const double ticks : {0.0, 0.5, 4.0, 20.0}) {
      const RelativePose ahead = track_.ahead(ticks);
      EXPECT_LT((ahead.translation - (at + ticks * step)).norm(), 1e-12);
      EXPECT_TRUE(ahead.rotation.isIdentity(1e-12));
    }
  }
}

TEST_F(PoseTracks, TurnOn) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  constexpr double kTurn = 0.01;
  for (std::size_t i = 0; i < 700; ++i) {  // more than once round
    add(pose_at(kTurn * static_cast<double>(i), {0, 0, 0}, axis));
    if (i == 0) continue;
    const RelativePose ahead = track_.ahead(10);
    const RelativePose wanted = pose_at(kTurn * (static_cast<double>(i) + 10), {0, 0, 0}, axis);
    EXPECT_LT((ahead.rotation - wanted.rotation).norm(), 1e-9) << i;
    EXPECT_TRUE((ahead.rotation.transpose() * ahead.rotation).isIdentity(1e-12));
  }
}

// The last kTicks alone count, however often the memory went round.
TEST_F(PoseTracks, ForgetWhatIsLongAgo) {
  for (int i = 0; i < 3; ++i) add(pose_at(0, {0.5 * i, 0, 0}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.5, 1e-12);
  for (std::size_t i = 0; i <= kTicks; ++i) add(pose_at(0, {2, 0.01 * static_cast<double>(i), 0}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.01, 1e-12);
  EXPECT_NEAR(track_.speed(), 0.01, 1e-12);
  for (int i = 0; i < 100; ++i) {  // each tick is the fastest for as long
    add(pose_at(0, {2, 0.01 * i, 0}));
    if (i < 4) continue;
    EXPECT_NEAR(track_.speed(), 0.01, 1e-12);
    if (i % 30 != 29) continue;
    for (std::size_t tick = 0; tick < 2 * kTicks; ++tick) {
      add(pose_at(0, {tick == 0 ? 0.0 : 2.0, 0.01 * i, 0}));
      EXPECT_EQ(track_.speed() > 1, tick <= kTicks) << tick;
    }
  }
  track_ = PoseTrack();
  EXPECT_EQ(track_.speed(), HUGE_VAL);
  add(pose_at(0, {0, 0, 1}));
  add(pose_at(0, {0, 0, 1.25}));
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0.25, 1e-12);
  EXPECT_NEAR(track_.ahead(1).translation[2], 1.5, 1e-12);
}

// To and fro: it is fast, and stays where it is.
TEST_F(PoseTracks, TellTremblingFromMoving) {
  for (int i = 0; i < 21; ++i) add(pose_at(0, {i % 2 == 0 ? 0.02 : -0.02, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0.04, 1e-12);
  EXPECT_NEAR(track_.drift(bound_, 0.1), 0, 1e-12);
  EXPECT_NEAR(track_.ahead(20).translation[0], 0.02, 1e-12);
  EXPECT_FALSE(track_.pace(bound_, 0.1).is_directed());
}

// One step of a body at rest shows in the speed for four ticks, and has no direction.
TEST_F(PoseTracks, TellAStepFromMoving) {
  for (int i = 0; i < 40; ++i) add(pose_at(0, {0, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0, 1e-12);
  for (std::size_t i = 0; i < kTicks; ++i) {
    add(pose_at(0, {0.1, 0, 0}));
    const Pace pace = track_.pace(bound_, 0.1);
    EXPECT_NEAR(pace.speed, 0.1, 1e-12);
    EXPECT_NEAR(pace.drift, 0.1 / kTicks, 1e-12);
    EXPECT_NEAR(pace.course, 0.1 / PoseTrack::kManyTicks, 1e-12);
    EXPECT_FALSE(pace.is_directed());
  }
  add(pose_at(0, {0.1, 0, 0}));
  EXPECT_NEAR(track_.speed(), 0, 1e-12);
}

// A motion is steady when it has gone on for some time.
TEST_F(PoseTracks, TellWhetherAMotionIsSteady) {
  for (int i = 0; i < 40; ++i) add(pose_at(0, {0, 0, 0}));
  int directed = 0, steady = 0;
  for (int i = 1; i <= 20; ++i) {
    add(pose_at(0, {0.01 * i, 0, 0}));
    directed += track_.pace(bound_, 0.1).is_directed() ? 1 : 0;
    steady += track_.pace(bound_, 0.1).is_steady() ? 1 : 0;
  }
  EXPECT_NEAR(directed, 19, 1);
  EXPECT_NEAR(steady, 13, 1);
}

}  // namespace
}  // namespace ist::test
