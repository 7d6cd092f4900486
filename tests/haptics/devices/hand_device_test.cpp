#include "loop/haptics/devices/hand_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/errors.h"
#include "support/random.h"

namespace ist::test {
namespace {

constexpr double kDt = 1e-3;
const Eigen::Vector3d kAxis(2.0 / 7, -3.0 / 7, 6.0 / 7);

// At rest at the origin, weakly damped; what a test needs else it says.
HandSettings settings() {
  return {.mechanics = {.damping = 0.5, .angular_damping = 0.5e-3, .delay = 0},
          .mass = 0.25,
          .inertia = 0.5e-3,
          .arm_stiffness = 400,
          .arm_damping = 1,
          .arm_angular_stiffness = 0.8,
          .arm_angular_damping = 1e-3,
          .resolution = 0,
          .angular_resolution = 0,
          .plan = {{0, {}}}};
}

HandSettings undamped() {
  HandSettings s = settings();
  s.mechanics.damping = s.mechanics.angular_damping = s.arm_damping = s.arm_angular_damping = 0;
  return s;
}

Vector6 both(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  Vector6 w;
  w << force, torque;
  return w;
}

// Starts at a place and an angle about kAxis, and is drawn to the origin within a moment: of all
// that follows, the response is free.
HandDevice released(HandSettings s, double distance, double angle) {
  Placement away;
  away.rotation = Eigen::AngleAxisd(angle, kAxis).toRotationMatrix();
  away.translation = distance * kAxis;
  s.plan = {{0, away}, {1e-12, {}}};
  return HandDevice(std::move(s));
}

double angle_of(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis().dot(kAxis);
}

// A damped oscillator that starts at rest at 1, at a time.
double free_response(double mass, double damping, double stiffness, double time) {
  const double decay = damping / (2 * mass);
  const double rate = std::sqrt(stiffness / mass - decay * decay);
  return std::exp(-decay * time) * (std::cos(rate * time) + decay / rate * std::sin(rate * time));
}

TEST(HandDevice, SwingsAsADampedOscillatorDoes) {
  const HandSettings s = settings();
  constexpr double kAway = 0.02, kAngle = 1e-3;
  // The rule is slow by the part (h w)²/12, and w is 40 rad/s for both: with 20 µs, 5.3e-8 of 40
  // radians in a second. The turn's spring is soft by turn²/24 at most.
  const double rate = 40;
  for (const double dt : {1e-3, 1e-4}) {
    const double period_error = std::pow(std::min(20e-6, dt / 16) * rate, 2) / 12;
    HandDevice hand = released(s, kAway, kAngle);
    for (int tick = 1; tick * dt <= 1; ++tick) {
      hand.write(Vector6::Zero(), dt);
      const double time = tick * dt, slow = 1.5 * period_error * rate * time + 1e-10;
      const double place =
          free_response(s.mass, s.mechanics.damping + s.arm_damping, s.arm_stiffness, time);
      ASSERT_LE((hand.pose().translation - kAway * place * kAxis).norm(), kAway * slow);
      const double turn =
          free_response(s.inertia, s.mechanics.angular_damping + s.arm_angular_damping,
                        s.arm_angular_stiffness, time);
      ASSERT_NEAR(angle_of(hand.pose().rotation), kAngle * turn,
                  kAngle * (slow + kAngle * kAngle / 24 * rate * time));
    }
    EXPECT_NEAR(hand.time(), 1, 1e-12);
  }
}

TEST(HandDevice, ComesToRestWhereTheArmHoldsAgainstAWrench) {
  HandSettings s = settings();
  s.arm_damping = 10;
  s.arm_angular_damping = 0.04;
  const Eigen::Vector3d force(1, -2, 3);
  for (const double turn : {0.01, 1.0, 2.0}) {
    HandDevice hand(s);
    // The spring's torque is 2k sin(turn/2).
    const Eigen::Vector3d torque = 2 * s.arm_angular_stiffness * std::sin(turn / 2) * kAxis;
    for (int tick = 0; tick < 3500; ++tick) hand.write(both(force, torque), kDt);
    EXPECT_LE((hand.pose().translation - force / s.arm_stiffness).norm(), 1e-14);
    EXPECT_NEAR(angle_of(hand.pose().rotation), turn, 1e-12);
    EXPECT_LE(hand.velocity().norm(), 1e-10);
    const double spring = force.squaredNorm() / (2 * s.arm_stiffness) +
                          4 * s.arm_angular_stiffness * (1 - std::cos(turn / 2));
    EXPECT_NEAR(hand.energy(), spring, 1e-12);
  }
}

TEST(HandDevice, FollowsItsPlanAtTheLagThatItsDampingMakes) {
  HandSettings s = settings();
  s.arm_damping = 20;
  s.arm_angular_damping = 0.04;
  s.mechanics = {.damping = 2, .angular_damping = 0.002, .delay = 0};
  const double speed = 0.05, spin = 0.3;
  const auto on_the_way = [&](double time) {
    return Placement{Eigen::AngleAxisd(spin * time, kAxis).toRotationMatrix(),
                     speed * time * kAxis};
  };
  s.plan.clear();
  for (int i = 0; i <= 20; ++i) s.plan.push_back({0.1 * i, on_the_way(0.1 * i)});
  HandDevice hand(s);
  for (int tick = 0; tick < 2000; ++tick) {
    EXPECT_FALSE(hand.done());
    if (tick > 1000) {
      // Only the device's own damping is against the room: k · lag = b · v.
      const double time = hand.time();
      const double lag = s.mechanics.damping * speed / s.arm_stiffness;
      EXPECT_NEAR(hand.pose().translation.dot(kAxis), speed * time - lag, 1e-9);
      EXPECT_NEAR(angle_of(hand.pose().rotation),
                  spin * time - s.mechanics.angular_damping * spin / s.arm_angular_stiffness, 1e-6);
    }
    hand.write(Vector6::Zero(), kDt);
  }
  for (int tick = 0; tick < 1000; ++tick) hand.write(Vector6::Zero(), kDt);
  EXPECT_TRUE(hand.done());
  const Placement end = on_the_way(2);
  EXPECT_LE((hand.pose().translation - end.translation).norm(), 1e-12);
  EXPECT_LE((hand.pose().rotation - end.rotation).norm(), 1e-12);
}

TEST(HandDevice, IsAtItsPlansStartAndDoneOnlyPastItsEnd) {
  HandSettings s = settings();
  s.plan = {{0, {}}, {0.125, {}}};
  HandDevice hand(s);
  for (int tick = 0; tick <= 128; ++tick) {
    EXPECT_EQ(hand.read()->translation, Eigen::Vector3d::Zero());
    EXPECT_FALSE(hand.done());
    hand.write(Vector6::Zero(), 0x1p-10);
  }
  EXPECT_TRUE(hand.done());
}

TEST(HandDevice, TellsWholeStepsOfItsEncodersRoundedDown) {
  constexpr double kStep = 1e-5, kTurnStep = 2e-4;
  HandSettings s = settings();
  s.resolution = kStep;
  s.angular_resolution = kTurnStep;
  s.plan[0].pose.translation = {0.1, 0.2, -0.3};
  s.plan[0].pose.rotation = Eigen::AngleAxisd(2, kAxis).toRotationMatrix();
  HandDevice hand(s);
  Random random(9);
  const Placement start = *hand.read();
  EXPECT_EQ(start.translation, s.plan[0].pose.translation);
  int moved = 0, turned = 0;
  for (int tick = 0; tick < 400; ++tick) {
    hand.write(both(random.point(-4, 4), random.point(-0.02, 0.02)), kDt);
    const Placement seen = *hand.read();
    const Vector6 exact = motion_between(s.plan[0].pose, hand.pose());
    const Vector6 told = motion_between(s.plan[0].pose, seen);
    for (int axis = 0; axis < 6; ++axis) {
      const double step = axis < 3 ? kStep : kTurnStep;
      const double steps = told[axis] / step;
      ASSERT_NEAR(steps, std::round(steps), 1e-9);
      ASSERT_GE(exact[axis] - told[axis], -1e-9 * step);
      ASSERT_LT(exact[axis] - told[axis], step * (1 + 1e-9));
      (axis < 3 ? moved : turned) += std::round(steps) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 1000);
  EXPECT_GT(turned, 1000);
}

TEST(HandDevice, TellsItsPoseExactlyWithoutResolution) {
  for (const bool turns : {false, true}) {
    HandSettings s = settings();
    s.plan[0].pose.translation = {1e-3, 2e-4, -3e-5};
    s.plan[0].pose.rotation = Eigen::AngleAxisd(2, kAxis).toRotationMatrix();
    (turns ? s.resolution : s.angular_resolution) = 1e-3;
    HandDevice hand(s);
    for (int tick = 0; tick < 50; ++tick) {
      hand.write(both({1, 2, 3}, {0.01, 0.02, 0}), kDt);
      EXPECT_EQ(hand.read()->rotation == hand.pose().rotation, turns);
      EXPECT_EQ(hand.read()->translation == hand.pose().translation, !turns);
    }
  }
}

TEST(HandDevice, FeelsAWrenchExactlyAfterTheDelay) {
  // Nothing but a mass: the rule is exact, and so is the way made since the force came.
  for (const double delay : {0.0, 0.3e-3, 1e-3, 2.5e-3, 10e-3}) {
    for (const double dt : {1e-4, 0.7e-3, 1e-3}) {
      HandSettings s = undamped();
      s.arm_stiffness = s.arm_angular_stiffness = 0;
      s.mechanics.delay = delay;
      HandDevice hand(s);
      const Vector6 wrench = both({0.5, 0, 0}, {0, 0, 1e-4});
      while (hand.time() < 0.02) {
        hand.write(wrench, dt);
        const double since = std::max(0.0, hand.time() - delay);
        ASSERT_NEAR(hand.pose().translation.x(), 0.5 / (2 * s.mass) * since * since, 1e-16)
            << delay << ' ' << dt;
        ASSERT_NEAR(hand.velocity()[0], 0.5 / s.mass * since, 1e-14);
        ASSERT_NEAR(hand.velocity()[5], 1e-4 / s.inertia * since, 1e-14);
        ASSERT_EQ(hand.velocity().norm() > 0, since > 0);
      }
    }
  }
}

TEST(HandDevice, HoldsEachWrenchUntilTheNextIsFelt) {
  // A delay of two and a half ticks: in each tick the wrench of three ticks ago, then that of two.
  HandSettings s = undamped();
  s.arm_stiffness = s.arm_angular_stiffness = 0;
  s.mechanics.delay = 2.5 * kDt;
  HandDevice hand(s);
  Random random(10);
  std::vector<double> forces;
  double impulse = 0;
  for (int tick = 0; tick < 300; ++tick) {
    forces.push_back(random.uniform(-1, 1));
    hand.write(both({0, forces.back(), 0}, {0, 0, 0}), kDt);
    if (tick >= 3) impulse += 0.5 * kDt * forces[static_cast<std::size_t>(tick) - 3];
    if (tick >= 2) impulse += 0.5 * kDt * forces[static_cast<std::size_t>(tick) - 2];
    ASSERT_NEAR(hand.velocity()[1], impulse / s.mass, 1e-13) << tick;
  }
}

TEST(HandDevice, GainsNoEnergyWhenNothingDrivesIt) {
  for (const double damped : {0.0, 1.0}) {
    HandSettings s = settings();
    s.mechanics.damping *= damped;
    s.mechanics.angular_damping *= damped;
    s.arm_damping *= damped;
    s.arm_angular_damping *= damped;
    HandDevice hand = released(s, 0.03, 1.9);
    hand.write(Vector6::Zero(), kDt);
    const double most = hand.energy();
    // As released: ½ k x² + 4k (1 - cos(turn/2)), less what a tick damps.
    const double given =
        0.5 * s.arm_stiffness * 0.03 * 0.03 + 4 * s.arm_angular_stiffness * (1 - std::cos(0.95));
    EXPECT_LE(most, given * (1 + 1e-6));
    double last = most;
    for (int tick = 0; tick < 2000; ++tick) {
      hand.write(Vector6::Zero(), kDt);
      // In a tick the spring gives 7 % at most, of which (h w)²/8, at 80 rad/s 3e-7, is not of its
      // own; damping takes more.
      ASSERT_LE(hand.energy(), last + (damped > 0 ? 1e-15 : 0.07 * 3e-7) * most) << tick;
      last = hand.energy();
    }
    if (damped == 0) {
      EXPECT_NEAR(last, most, 3e-7 * most);
    } else {
      EXPECT_LE(last, 0.01 * most);
    }
  }
}

TEST(HandDevice, GainsWhatTheWrenchGivesAndLosesWhatIsDamped) {
  Random random(11);
  HandDevice hand(undamped()), damped(settings());
  HandSettings own = settings();
  own.arm_damping = own.arm_angular_damping = 0;
  HandDevice loose(own);
  double scale = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const Vector6 wrench = both(random.point(-5, 5), random.point(-0.05, 0.05));
    hand.write(wrench, kDt);
    damped.write(wrench, kDt);
    scale = std::max(scale, hand.energy());
    ASSERT_NEAR(hand.energy(), hand.work(), 1e-6 * scale) << tick;
    EXPECT_EQ(hand.damped(), 0);
    ASSERT_LT(damped.energy() + damped.damped(), damped.work());
    // Where the arm damps nothing, the device's own damping takes all that is lost.
    loose.write(wrench, kDt);
    ASSERT_NEAR(loose.energy() + loose.damped(), loose.work(), 1e-6 * scale) << tick;
  }
  EXPECT_GT(scale, 1e-3);
  EXPECT_GT(loose.damped(), 0.01 * loose.work());
}

TEST(HandDevice, IsTheSameEveryTime) {
  const auto run = [] {
    HandSettings s = settings();
    s.mechanics.delay = 0.8e-3;
    HandDevice hand = released(s, 0.01, 0.5);
    Random random(12);
    for (int tick = 0; tick < 200; ++tick) {
      hand.write(both(random.point(-5, 5), random.point(-0.05, 0.05)), kDt);
    }
    return hand;
  };
  const HandDevice a = run(), b = run();
  EXPECT_EQ(a.pose().translation, b.pose().translation);
  EXPECT_EQ(a.pose().rotation, b.pose().rotation);
  EXPECT_EQ(a.velocity(), b.velocity());
  EXPECT_EQ(a.work(), b.work());
}

TEST(HandDevice, RefusesSettingsWithoutSenseNamingThem) {
  const auto refusal = [](auto change) {
    HandSettings s = settings();
    change(s);
    const auto error = error_of([&] { const HandDevice hand(s); });
    if (!error) return std::string("fine");
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    return std::string(error->what());
  };
  EXPECT_EQ(refusal([](HandSettings&) {}), "fine");
  EXPECT_EQ(refusal([](HandSettings& s) { s.mechanics.delay = HandDevice::kLongestDelay; }),
            "fine");
  EXPECT_EQ(refusal([](HandSettings& s) { s.mass = 0; }),
            "HandSettings: mass is 0: give a number from 1e-09 to 1000000000");
  EXPECT_EQ(refusal([](HandSettings& s) { s.mechanics.delay = 0.011; }),
            "HandSettings: delay is 0.011: give a number from 0 to 0.01");
  double HandSettings::*const others[] = {
      &HandSettings::inertia,           &HandSettings::arm_stiffness,
      &HandSettings::arm_damping,       &HandSettings::arm_angular_stiffness,
      &HandSettings::resolution,        &HandSettings::arm_angular_damping,
      &HandSettings::angular_resolution};
  for (const auto member : others) {
    for (const double bad : {-1e-6, std::nan(""), HUGE_VAL}) {
      EXPECT_NE(refusal([&](HandSettings& s) { s.*member = bad; }), "fine") << bad;
    }
  }
  for (double DeviceMechanics::*const member :
       {&DeviceMechanics::damping, &DeviceMechanics::angular_damping, &DeviceMechanics::delay}) {
    EXPECT_NE(refusal([&](HandSettings& s) { s.mechanics.*member = -1e-9; }), "fine");
    EXPECT_NE(refusal([&](HandSettings& s) { s.mechanics.*member = std::nan(""); }), "fine");
  }
  EXPECT_EQ(refusal([](HandSettings& s) { s.plan.clear(); }),
            "the plan has no waypoint: give at least one, at time 0");
}

}  // namespace
}  // namespace ist::test
