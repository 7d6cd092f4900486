#include "loop/haptics/devices/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "ist/haptics/devices/device.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist::test {
namespace {

Placement placement(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  return {Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(), translation};
}

// Waypoints at uneven times, with turns of up to 115 degrees between them.
std::vector<Waypoint> any_waypoints(Random& random, int count) {
  std::vector<Waypoint> waypoints{
      {0, placement(random.uniform(-3, 3), random.direction(), {0, 0, 0})}};
  waypoints[0].pose.translation = random.point(-0.1, 0.1);
  while (static_cast<int>(waypoints.size()) < count) {
    const Waypoint& before = waypoints.back();
    const Placement turn = placement(random.uniform(-2, 2), random.direction(), {0, 0, 0});
    waypoints.push_back({before.time + random.uniform(0.01, 1),
                         {turn.rotation * before.pose.rotation, random.point(-0.1, 0.1)}});
  }
  return waypoints;
}

double distance(const Placement& a, const Placement& b) {
  return (a.rotation - b.rotation).norm() + (a.translation - b.translation).norm();
}

TEST(Plan, PassesThroughItsWaypointsAndStaysAtTheLast) {
  Random random(6);
  const std::vector<Waypoint> waypoints = any_waypoints(random, 20);
  Plan plan(waypoints);
  EXPECT_EQ(plan.end(), waypoints.back().time);
  EXPECT_LE(distance(plan.start(), waypoints[0].pose), 1e-15);
  for (const Waypoint& waypoint : waypoints) {
    EXPECT_LE(distance(plan.at(waypoint.time).pose, waypoint.pose), 5e-15);
    // And reaches them without a jump, at up to 200 rad/s.
    const double before = std::nextafter(waypoint.time, 0);
    EXPECT_LE(distance(plan.at(before).pose, waypoint.pose), 1e-12);
  }
  for (const double later : {1e-9, 1.0, 1e9}) {
    const PlanPoint point = plan.at(plan.end() + later);
    EXPECT_EQ(distance(point.pose, plan.at(plan.end()).pose), 0);
    EXPECT_TRUE((point.velocity.array() == 0).all());
  }
}

TEST(Plan, GoesStraightAtOneSpeedAndTurnsAboutOneAxis) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  constexpr double kTurn = 2.0, kDuration = 0.5;
  Plan plan({{0, placement(0, axis, {0, 0, 0})}, {kDuration, placement(kTurn, axis, {1, 2, 3})}});
  double slowest = 1e300, fastest = 0;
  for (int i = 0; i < 100; ++i) {
    const double part = i / 100.0;
    const PlanPoint point = plan.at(part * kDuration);
    EXPECT_LE((point.pose.translation - part * Eigen::Vector3d(1, 2, 3)).norm(), 1e-15);
    // The quaternion's interpolation, by the angle that it has in closed form.
    const double angle =
        2 * std::atan2(part * std::sin(kTurn / 2), 1 - part + part * std::cos(kTurn / 2));
    EXPECT_LE(distance(point.pose, placement(angle, axis, point.pose.translation)), 2e-15);
    const double speed = point.velocity.tail<3>().norm();
    EXPECT_LE((point.velocity.tail<3>() - speed * axis).norm(), 1e-14);
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
  }
  EXPECT_LE(fastest, 4.0 / 3 * kTurn / kDuration);
  EXPECT_GE(slowest, 3.0 / 4 * kTurn / kDuration);
}

TEST(Plan, TellsTheVelocityAtWhichItsPoseMoves) {
  Random random(7);
  Plan plan(any_waypoints(random, 10));
  constexpr double kStep = 1e-6;
  for (double time = 0.003; time < plan.end(); time += 0.007) {
    const Vector6 moved = motion_between(plan.at(time - kStep).pose, plan.at(time + kStep).pose);
    const Vector6 velocity = plan.at(time).velocity;
    // Central differences: of second order but at a waypoint, where the velocity changes.
    if ((plan.at(time - kStep).velocity - plan.at(time + kStep).velocity).norm() > 0.01) continue;
    EXPECT_LE((moved / (2 * kStep) - velocity).norm(), 1e-7 * (1 + velocity.norm())) << time;
  }
}

TEST(Plan, IsTheSameInWhateverOrderItIsAsked) {
  Random random(8);
  const std::vector<Waypoint> waypoints = any_waypoints(random, 50);
  Plan ascending(waypoints), jumping(waypoints);
  std::vector<double> times;
  for (double time = 0; time < ascending.end() + 1; time += 0.013) times.push_back(time);
  std::vector<PlanPoint> points;
  for (const double time : times) points.push_back(ascending.at(time));
  for (int i = 0; i < samples(2000); ++i) {
    const std::size_t k = random.below(static_cast<std::uint32_t>(times.size()));
    const PlanPoint point = jumping.at(times[k]);
    ASSERT_EQ(distance(point.pose, points[k].pose), 0);
    ASSERT_EQ(point.velocity, points[k].velocity);
  }
}

TEST(Plan, OfOneWaypointStaysThere) {
  const Placement pose = placement(1, {0, 0, 1}, {0.1, 0.2, 0.3});
  Plan plan({{0, pose}});
  EXPECT_EQ(plan.end(), 0);
  for (const double time : {0.0, 0.5, 10.0}) EXPECT_LE(distance(plan.at(time).pose, pose), 1e-15);
}

std::string refusal(std::vector<Waypoint> waypoints) {
  const auto error = error_of([&] { const Plan plan(std::move(waypoints)); });
  if (!error) return "fine";
  EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  return error->what();
}

TEST(Plan, RefusesWhatIsNoneAndSaysWhereAndWhy) {
  const Placement still;
  Placement lost;
  lost.translation.y() = std::numeric_limits<double>::quiet_NaN();
  Placement skewed;
  skewed.rotation(0, 1) = 0.01;
  const Placement round = placement(2.2, {1, 1, 0}, {0, 0, 0});
  const Placement half = placement(std::numbers::pi, {0, 0, 1}, {0, 0, 0});
  const Placement third = placement(2 * std::numbers::pi / 3, {0, 1, 0}, {0, 0, 0});
  EXPECT_EQ(refusal({}), "the plan has no waypoint: give at least one, at time 0");
  const struct {
    std::vector<Waypoint> waypoints;
    const char* says;
  } cases[] = {
      {{{0.5, still}}, "waypoint 0 (from 0): the first time is 0.5 s: let the plan start at 0"},
      {{{std::nan(""), still}}, "waypoint 0 (from 0): the first time is nan s"},
      {{{0, still}, {0, still}}, "waypoint 1 (from 0): the time 0 s does not come after 0 s"},
      {{{0, still}, {1, still}, {0.5, still}}, "waypoint 2 (from 0): the time 0.5 s"},
      {{{0, still}, {std::nan(""), still}}, "waypoint 1 (from 0): the time is nan s"},
      {{{0, still}, {INFINITY, still}}, "waypoint 1 (from 0): the time is inf s"},
      {{{0, lost}}, "waypoint 0 (from 0): the pose is no rigid motion"},
      {{{0, still}, {1, skewed}}, "waypoint 1 (from 0): the pose is no rigid motion"},
      {{{0, still}, {1, round}},
       "waypoint 1 (from 0): the turn from the waypoint before is more than a third"},
      {{{0, still}, {1, half}},
       "waypoint 1 (from 0): the turn from the waypoint before is more than a third"},
  };
  for (const auto& c : cases) {
    EXPECT_NE(refusal(c.waypoints).find(c.says), std::string::npos)
        << c.says << " not in " << refusal(c.waypoints);
  }
  EXPECT_EQ(refusal({{0, still}, {1, third}, {2, still}}), "fine");
}

TEST(NullDevice, StaysWhateverItIsTold) {
  const Placement pose = placement(1, {0, 0, 1}, {0.1, 0.2, 0.3});
  const std::unique_ptr<Device> device =
      make_null_device(pose, {.damping = 2, .angular_damping = 0.1, .delay = 1e-3});
  EXPECT_EQ(device->mechanics().damping, 2);
  for (int tick = 0; tick < 10; ++tick) {
    const std::optional<Placement> seen = device->read();
    ASSERT_TRUE(seen);
    EXPECT_EQ(distance(*seen, pose), 0);
    device->write(Vector6::Constant(100), 1e-3);
    EXPECT_FALSE(device->done());
  }
}

}  // namespace
}  // namespace ist::test
