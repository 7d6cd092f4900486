#include "loop/haptics/effects/friction_effect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "haptics/effects/effect_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

inline constexpr double kPressStiffness = 1000;  // N/m, of the contact

/// A tool that is pressed on a plane with the normal z. Its contact points stay in place on the
/// tool.
class PressedTool {
 public:
  /// Each of `feet`, in the tool's frame, carries its part of `load`, N.
  PressedTool(const FrictionSettings& settings, std::vector<Eigen::Vector3d> feet, double load)
      : contact_({kPressStiffness, 0.5}), friction_(settings, contact_), feet_(std::move(feet)) {
    press(load);
  }
  PressedTool(const PressedTool&) = delete;  // friction_ refers to contact_
  PressedTool& operator=(const PressedTool&) = delete;

  void press(double load) {
    load_ = load;
    at_.contacts.clear();
    for (const Eigen::Vector3d& foot : feet_) {
      const double each = load / (kPressStiffness * static_cast<double>(feet_.size()));
      at_.add_contact({at_.tool.rotation * foot, {0, 0, 1}, each, 1});
    }
  }
  void lift() { at_.contacts.clear(); }
  /// One tick. Returns the wrench at its end, as the law had it within the tick.
  Vector6 move(const Vector6& motion) {
    const Vector6 wrench = respond(friction_, at_, motion).wrench;
    const bool touches = !at_.contacts.points().empty();
    friction_.advance(at_.input(), motion);
    at_.tool = at_.tool.moved(motion);
    if (touches) press(load_);
    return wrench;
  }
  Vector6 slide(double x, double y = 0) { return move(six({x, y, 0}, {0, 0, 0})); }
  Vector6 turn(double angle) { return move(six({0, 0, 0}, {0, 0, angle})); }
  /// The wrench of a tick without motion.
  [[nodiscard]] Vector6 wrench() const { return respond(friction_, at_).wrench; }
  [[nodiscard]] const EffectCase& at() const { return at_; }
  [[nodiscard]] FrictionEffect& friction() { return friction_; }

 private:
  ContactEffect contact_;
  FrictionEffect friction_;
  std::vector<Eigen::Vector3d> feet_;
  EffectCase at_;
  double load_ = 0;
};

using Eigen::Vector3d;

constexpr double kAcross = 500;  // N/m
constexpr FrictionSettings kGrip{
    .static_coefficient = 0.5, .dynamic_coefficient = 0.3, .stiffness = kAcross};
constexpr double kLoad = 2;                        // N
constexpr double kStatic = 0.5 * kLoad / kAcross;  // m: at 2 mm it begins to slide
constexpr double kDynamic = 0.3 * kLoad / kAcross;

PressedTool one_foot(const FrictionSettings& settings = kGrip) {
  return {settings, {Vector3d::Zero()}, kLoad};
}

bool same_numbers(const Placement& a, const Placement& b) {
  return a.rotation == b.rotation && a.translation == b.translation;
}

TEST(FrictionEffect, NeedsNormalsAndDepthAndNoVelocity) {
  PressedTool tool = one_foot();
  EXPECT_EQ(tool.friction().name(), "friction");
  EXPECT_EQ(asked(tool.friction().needs()), (std::array{true, true, false, false, false}));
}

TEST(FrictionEffect, SticksBelowItsLimitAndDoesNotDriftAtRest) {
  PressedTool tool = one_foot();
  for (int i = 0; i < 9; ++i) tool.slide(0.08 * kStatic, 0.06 * kStatic);
  ASSERT_TRUE(tool.friction().anchor());
  const Placement anchor = *tool.friction().anchor();
  EXPECT_TRUE(same_numbers(anchor, Placement{}));
  const Vector3d force = -kAcross * 0.9 * kStatic * Vector3d(0.8, 0.6, 0);
  for (int i = 0; i < 10'000; ++i) {
    tool.slide(0);
    ASSERT_TRUE(same_numbers(*tool.friction().anchor(), anchor)) << i;
    ASSERT_LE((tool.wrench() - six(force, Vector3d::Zero())).norm(), 1e-12) << i;
  }
  // A hand that trembles below the limit changes nothing either.
  Random random(61);
  for (int i = 0; i < samples(10'000); ++i) {
    const Vector3d here = tool.at().tool.translation;
    tool.move(six(0.5 * kStatic * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0) - here,
                  Vector3d::Zero()));
    ASSERT_TRUE(same_numbers(*tool.friction().anchor(), anchor)) << i;
    ASSERT_FALSE(tool.friction().slides());
  }
}

TEST(FrictionEffect, SlidesBeyondItsLimitWithWhatIsLeftOfItAgainstTheWay) {
  PressedTool tool = one_foot();
  // Within a tick the force is at most µ_s of the load, over any distance.
  const Vector6 torn = tool.slide(3 * 0.6 * kStatic, 3 * 0.8 * kStatic);
  EXPECT_LE((torn - six(-0.5 * kLoad * Vector3d(0.6, 0.8, 0), Vector3d::Zero())).norm(), 1e-12);
  EXPECT_TRUE(tool.friction().slides());
  for (int i = 0; i < 50; ++i) {
    const Vector6 expected = six(-0.3 * kLoad * Vector3d(0.6, 0.8, 0), Vector3d::Zero());
    ASSERT_LE((tool.wrench() - expected).norm(), 1e-9) << i;
    ASSERT_LE((tool.slide(6e-5, 8e-5) - expected).norm(), 1e-9) << i;
    ASSERT_TRUE(tool.friction().slides());
  }
}

TEST(FrictionEffect, LetsGoAtStaticAndHoldsAgainOnlyBelowDynamic) {
  PressedTool tool = one_foot();
  tool.slide(0.999 * kStatic);
  EXPECT_FALSE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.999 * 0.5 * kLoad, 1e-12);
  tool.slide(0.002 * kStatic);
  EXPECT_TRUE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.3 * kLoad, 1e-12);
  tool.slide(1e-5);  // slides on: µ_s is forgotten
  EXPECT_TRUE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.3 * kLoad, 1e-12);
  tool.slide(0);  // a rest, and it holds up to µ_s
  EXPECT_FALSE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.3 * kLoad, 1e-12);
  tool.slide(0.999 * (kStatic - kDynamic));
  EXPECT_FALSE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -kAcross * (kDynamic + 0.999 * (kStatic - kDynamic)), 1e-12);
  tool.slide(0.002 * kStatic);
  EXPECT_TRUE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.3 * kLoad, 1e-12);
}

TEST(FrictionEffect, TurnsBackThroughItsSpring) {
  PressedTool tool = one_foot();
  tool.slide(2 * kStatic);
  const double step = 0.05 * kDynamic;
  for (int i = 1; i <= 50; ++i) {
    tool.slide(-step);
    const double expected = -0.3 * kLoad + kAcross * step * i;
    if (expected < 0.5 * kLoad * 0.999) {
      ASSERT_NEAR(tool.wrench()[0], expected, 1e-12) << i;
      ASSERT_FALSE(tool.friction().slides()) << i;
    }
  }
  for (int i = 0; i < 20; ++i) tool.slide(-step);
  EXPECT_TRUE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], 0.3 * kLoad, 1e-12);
}

TEST(FrictionEffect, HoldsATurnByPointsThatLieApart) {
  constexpr double kArm = 0.02;
  PressedTool tool(kGrip, {{kArm, 0, 0}, {-kArm, 0, 0}}, kLoad);
  const double angle = 0.01;  // each foot goes 0.2 mm, and would slide at 1 mm
  tool.turn(angle);
  EXPECT_FALSE(tool.friction().slides());
  // The sine of an angle, in twice its half's tangent.
  const double sine = angle / (1 + 0.25 * angle * angle);
  EXPECT_LE((tool.wrench() - six({0, 0, 0}, {0, 0, -2 * kAcross * kArm * kArm * sine})).norm(),
            1e-15);
  for (int i = 0; i < 20; ++i) tool.turn(angle);
  EXPECT_TRUE(tool.friction().slides());
  // The whole load at that arm. An arc of 0.03 is a little shorter than its tangent.
  EXPECT_NEAR(tool.wrench()[5], -0.3 * kLoad * kArm, 1e-3 * 0.3 * kLoad * kArm);
  EXPECT_LE(tool.wrench().head<5>().norm(), 1e-12);
  // One point cannot hold it.
  PressedTool pin = one_foot();
  pin.turn(0.1);
  EXPECT_LE(pin.wrench().norm(), 1e-15);
}

TEST(FrictionEffect, WeighsPointsByTheirShares) {
  const ContactEffect contact({kPressStiffness, 0.5});
  FrictionEffect friction(kGrip, contact);
  EffectCase c;  // loads of 2 and 0.25 N
  c.add_contact({{0.01, 0, 0}, {0, 0, 1}, 2e-3, 1});
  c.add_contact({{-0.01, 0, 0}, {0, 0, 1}, 1e-3, 0.25});
  const double stuck = 5e-4, torn = 5e-3;
  const Vector6 held = respond(friction, c, six({0, stuck, 0}, {0, 0, 0})).wrench;
  EXPECT_LE((held - six({0, -1.25 * kAcross * stuck, 0}, {0, 0, -0.0075 * kAcross * stuck})).norm(),
            1e-14);
  // One limit for both, in parts of 4 to 1.
  const double most = 0.5 * 2.25;
  const Vector6 sliding = respond(friction, c, six({0, torn, 0}, {0, 0, 0})).wrench;
  EXPECT_LE((sliding - six({0, -most, 0}, {0, 0, -0.01 * 0.6 * most})).norm(), 1e-14);
}

TEST(FrictionEffect, LetsGoWhenTheLoadGoes) {
  PressedTool tool = one_foot();
  tool.slide(0.9 * kStatic);
  EXPECT_NEAR(tool.wrench()[0], -0.9 * 0.5 * kLoad, 1e-12);
  tool.press(0.5 * kLoad);
  EXPECT_NEAR(tool.wrench()[0], -0.5 * 0.5 * kLoad, 1e-12);
  tool.slide(0);
  EXPECT_TRUE(tool.friction().slides());
  EXPECT_NEAR(tool.wrench()[0], -0.3 * 0.5 * kLoad, 1e-12);
  // The stretch is gone with it: a greater load does not bring it back.
  tool.press(4 * kLoad);
  EXPECT_NEAR(tool.wrench()[0], -0.3 * 0.5 * kLoad, 1e-12);
  tool.press(0);
  EXPECT_EQ(tool.wrench().norm(), 0);
}

TEST(FrictionEffect, FeelsTheLoadThatTheMotionOfTheTickTakesAway) {
  PressedTool tool = one_foot();
  tool.slide(0.9 * kStatic);
  const double lift = 0.5 * kLoad / kPressStiffness;
  EXPECT_NEAR(tool.move(six({0, 0, lift}, {0, 0, 0}))[0], -0.5 * 0.5 * kLoad, 1e-12);
  EXPECT_TRUE(tool.friction().slides());
}

TEST(FrictionEffect, ForgetsItsAnchorWhenLiftedOff) {
  for (const bool by_motion : {false, true}) {
    PressedTool tool = one_foot();
    tool.slide(2 * kStatic);
    ASSERT_TRUE(tool.friction().slides());
    if (by_motion) {  // the points are still there, and nothing presses
      tool.move(six({0, 0, 2 * kLoad / kPressStiffness}, {0, 0, 0}));
    } else {
      tool.lift();
      tool.slide(0);
    }
    EXPECT_FALSE(tool.friction().anchor());
    EXPECT_FALSE(tool.friction().slides());
    tool.lift();
    tool.slide(5 * kStatic);
    const Placement landed = tool.at().tool;
    tool.press(kLoad);
    EXPECT_LE(tool.wrench().norm(), 1e-15);
    const Vector6 first = tool.slide(0.1 * kStatic);  // held from its first pose on
    EXPECT_NEAR(first[0], -0.1 * 0.5 * kLoad, 1e-12);
    ASSERT_TRUE(tool.friction().anchor());
    EXPECT_TRUE(same_numbers(*tool.friction().anchor(), landed));
  }
  PressedTool tool = one_foot();
  tool.slide(0.5 * kStatic);
  tool.friction().reset();
  EXPECT_FALSE(tool.friction().anchor());
  EXPECT_LE(tool.wrench().norm(), 1e-15);
}

TEST(FrictionEffect, HasNoStepFromSlidingToStickingNorWhereBothLimitsAreOne) {
  Random random(62);
  FrictionSettings even = kGrip;
  even.static_coefficient = even.dynamic_coefficient;
  int switches = 0;
  for (const FrictionSettings& settings : {kGrip, even}) {
    PressedTool tool(settings, {{0.01, 0, 0}, {-0.01, 0.01, 0}, {0, -0.01, 0}}, kLoad);
    for (int i = 0; i < samples(5000); ++i) {
      const bool slid = tool.friction().slides();
      const Vector6 within =
          tool.move(six({random.uniform(-1, 1) * 3e-4, random.uniform(-1, 1) * 3e-4, 0},
                        {0, 0, random.uniform(-1, 1) * 1e-2}));
      const bool slides = tool.friction().slides();
      if (slid == slides) continue;
      ++switches;
      if (slides && settings.static_coefficient > settings.dynamic_coefficient) continue;
      // What the next tick begins with, to within what the tick's turn leaves of a place's motion,
      // 1e-4/2 of an arm of 14 mm at each of three points.
      const Vector6 step = tool.wrench() - within;
      ASSERT_LE(step.head<3>().norm(), 3 * kAcross * 0.014 * 1e-4) << i;
      ASSERT_LE(step.tail<3>().norm(), 3 * kAcross * 0.014 * 0.014 * 1e-2) << i;
    }
  }
  EXPECT_GT(switches, samples(50));
}

TEST(FrictionEffect, HasTheStiffnessThatDifferencesShowWhileItSticks) {
  Random random(63);
  const ContactEffect contact({kPressStiffness, 0.5});
  FrictionSettings strong = kGrip;
  strong.static_coefficient = 1e6;
  for (int i = 0; i < samples(200); ++i) {
    FrictionEffect friction(strong, contact);
    EffectCase c = random_case(random, 1 + i % 6);
    const Vector6 before = six(random.point(-5e-6, 5e-6), random.point(-2e-4, 2e-4));
    friction.advance(c.input(), before);
    ASSERT_TRUE(friction.anchor() && !friction.slides());
    const Vector6 motion = six(random.point(-5e-6, 5e-6), random.point(-2e-4, 2e-4));
    const Response response = respond(friction, c, motion);
    // Linear between its kinks: only rounding is left, over a step of 1e-6.
    ASSERT_LE(difference(response.stiffness, measured_stiffness(friction, c, motion, 1e-6)), 1e-7);
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
  }
}

TEST(FrictionEffect, HasTheStiffnessOfItsSecantWhileItSlides) {
  Random random(64);
  const ContactEffect contact({kPressStiffness, 0.5});
  for (int i = 0; i < samples(200); ++i) {
    const FrictionEffect friction(kGrip, contact);
    const EffectCase c = random_case(random, 1 + i % 6);
    const Vector6 motion = six(random.point(-1e-2, 1e-2), random.point(-1e-2, 1e-2));
    const Response response = respond(friction, c, motion);
    ASSERT_TRUE(is_symmetric_and_semidefinite(response.stiffness));
    // From zero stretch, the secant ends on the law's curve.
    ASSERT_LE((response.stiffness * motion + response.wrench).norm(), 1e-12);
  }
  // Across the way of sliding the secant is the tangent.
  PressedTool tool = one_foot();
  const Vector6 far = six({4 * kStatic, 0, 0}, {0, 0, 0});
  const Matrix6 measured = measured_stiffness(tool.friction(), tool.at(), far, 1e-7);
  const Matrix6 given = respond(tool.friction(), tool.at(), far).stiffness;
  EXPECT_NEAR(given(1, 1), kAcross / 4, 1e-9);
  EXPECT_NEAR(measured(1, 1), given(1, 1), 1e-5);
  EXPECT_NEAR(measured(0, 0), 0, 1e-5);
}

constexpr FrictionSettings kHold{
    .static_coefficient = 0.5, .dynamic_coefficient = 0.3, .stiffness = 500};

TEST(FrictionEffect, TakesWorkOnEveryPathFromItsFirstTickOn) {
  Random random(71);
  for (int path = 0; path < samples(20); ++path) {
    PressedTool tool(kHold, {Vector3d::Zero()}, 1);
    double work = 0;
    int slid = 0;
    for (int i = 0; i < 2000; ++i) {
      tool.press(random.uniform(0.1, 2));
      const Vector6 motion =
          six({random.uniform(-1, 1) * 4e-4, random.uniform(-1, 1) * 4e-4, 0}, {0, 0, 0});
      work -= tool.move(motion).dot(motion);
      slid += tool.friction().slides();
      ASSERT_GE(work, -1e-15) << i;
    }
    EXPECT_GT(slid, 20);
    EXPECT_LT(slid, 1980);
    EXPECT_GT(work, 1e-4);
  }
}

TEST(FrictionEffect, LosesWhatItSaysOnAClosedPath) {
  // Sliding there and back costs µ_d N times the way, less the energy of the spring at the turns.
  constexpr double kWeight = 2, kWay = 0.05;
  constexpr int kSteps = 5000;
  FrictionSettings even = kHold;
  even.static_coefficient = even.dynamic_coefficient;
  PressedTool tool(even, {Vector3d::Zero()}, kWeight);
  double work = 0;
  for (int lap = 0; lap < 4; ++lap) {
    const double step = (lap % 2 == 0 ? kWay : -kWay) / kSteps;
    for (int i = 0; i < kSteps; ++i) work -= tool.slide(step)[0] * step;
  }
  const double force = 0.3 * kWeight, stretch = force / even.stiffness;
  // Each change of direction lets the spring go and draws it anew, over twice the stretch, in which
  // the force is 0 on the mean; the first draws it once.
  const double expected = 4 * kWay * force - 3 * 2 * stretch * force - 0.5 * stretch * force;
  EXPECT_NEAR(work, expected, 1e-3 * expected);
}

TEST(FrictionEffect, TakesWorkThoughTheToolTurns) {
  Random random(72);
  for (int path = 0; path < samples(10); ++path) {
    PressedTool tool(kHold, {{0.01, 0, 0}, {-0.01, 0.008, 0}, {0, -0.012, 0}}, 1);
    double work = 0, least = 0;
    Vector3d heading = Vector3d::Zero();
    for (int i = 0; i < 2000; ++i) {
      // Wandering, slowly enough that it sticks and slides by turns.
      heading = 0.95 * heading + 0.3 * random.point(-1, 1);
      const Vector6 motion =
          six({4e-5 * heading[0], 4e-5 * heading[1], 0}, {0, 0, 3e-3 * heading[2]});
      work -= tool.move(motion).dot(motion);
      least = std::min(least, work);
    }
    EXPECT_GT(work, 1e-3);
    EXPECT_GE(least, -1e-6 * work);
  }
}

TEST(FrictionEffect, ComesToRestAfterEverySlide) {
  Random random(73);
  for (int path = 0; path < samples(20); ++path) {
    PressedTool tool(kHold, {{0.01, 0, 0}, {-0.01, 0.008, 0}, {0, -0.012, 0}}, 1);
    const Vector6 motion = six({random.uniform(-1, 1) * 1e-3, random.uniform(-1, 1) * 1e-3, 0},
                               {0, 0, random.uniform(-1, 1) * 0.05});
    for (int i = 0; i < 20; ++i) tool.move(motion);
    ASSERT_TRUE(tool.friction().slides());
    for (int i = 0; i < 5; ++i) tool.slide(0);
    ASSERT_FALSE(tool.friction().slides());
    const Placement anchor = *tool.friction().anchor();
    const double held = tool.wrench().norm();
    for (int i = 0; i < 1000; ++i) {
      tool.slide(0);
      ASSERT_EQ(tool.friction().anchor()->rotation, anchor.rotation);
      ASSERT_EQ(tool.friction().anchor()->translation, anchor.translation);
    }
    EXPECT_GT(held, 0);
    EXPECT_NEAR(tool.wrench().norm(), held, 1e-9 * held);
  }
}

}  // namespace
}  // namespace ist::test
