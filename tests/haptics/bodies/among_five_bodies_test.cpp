// A hand that presses at random among five bodies, and takes and releases one in between.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "haptics/bodies/body_cases.h"
#include "haptics/human_pair.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/stability_border.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLooseBall = 3;
constexpr int kTicksOfAPress = 2000, kTicksToBegin = 1000;
const Vector3d kAbove(0, 0, 5);  // of the hand's place between presses, mm from the start

// What a press does, and where the hand rests after it, mm from the start.
struct RandomPress {
  Vector3d first, second, rest;
  bool changes;  // after it the loose ball is taken, or released
};

// Presses one after the other. With the loose ball in the hand it bears first: the hand stays over
// the floor's middle, and the ball gets another place by each release, over its first one.
std::vector<RandomPress> random_presses(int count) {
  Random random(83);
  std::vector<RandomPress> all;
  bool held = false;
  Vector3d ball = Vector3d::Zero(),
           carried_to = kAbove;  // the ball's shift, the hand at the change
  for (int i = 0; i < count; ++i) {
    const double low = held ? 0.5 : -3.5, far = held ? 10 : 24;
    const auto target = [&] {
      return Vector3d(random.uniform(-9.5, 9.5), random.uniform(-10, far),
                      random.uniform(low, low + 6));
    };
    RandomPress press{target(), target(), kAbove, i % 4 != 3};
    if (press.changes && held) {
      const Vector3d there(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 3));
      carried_to += there - ball;
      press.rest = carried_to;
      ball = there;
    }
    if (press.changes) {
      held = !held;
      carried_to = kAbove;
    }
    all.push_back(press);
  }
  return all;
}

// The arm damps no more than it must to be at rest where the loose ball is taken and released: that
// could hide what the loop gives.
HandDevice hand_of_presses(const std::vector<RandomPress>& all, const Placement& start) {
  std::vector<Waypoint> plan{{0, start}, {1, moved_by(start, kAbove)}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double begin = 1 + kPeriod * kTicksOfAPress * static_cast<double>(i);
    plan.push_back({begin + 0.5, moved_by(start, all[i].first)});
    plan.push_back({begin + 0.7, moved_by(start, all[i].first)});
    plan.push_back({begin + 1.1, moved_by(start, all[i].second)});
    plan.push_back({begin + 1.2, moved_by(start, all[i].second)});
    plan.push_back({begin + 1.6, moved_by(start, all[i].rest)});
    plan.push_back({begin + 2.0, moved_by(start, all[i].rest)});
  }
  HandSettings hand = hand_of(std::move(plan));
  hand.arm_damping = 3;
  hand.arm_angular_damping = 3e-3;
  return HandDevice(std::move(hand));
}

// What a hand feels among the bodies.
class Felt {
 public:
  Felt(const std::string& name, const CouplingSettings& coupling)
      : steps_("long runs", "force from tick to tick" + name, "N"),
        turns_("long runs", "torque from tick to tick" + name, "N m"),
        energy_(name, coupling) {}

  void tick(Simulation& simulation, HandDevice& device) {
    const Placement before = device.pose();
    const Vector6 velocity = device.velocity();
    const double work = device.work(), damped = device.damped();
    const Tick tick = simulation.tick(device.read(), {});
    device.write(tick.wrench, kPeriod);
    ASSERT_FALSE(tick.fault || tick.held);
    const Vector6 step = tick.wrench - last_;
    last_ = tick.wrench;
    steps_.sample(step.head<3>().norm(), kSafety.force_slew * kPeriod * (1 + 1e-9));
    turns_.sample(step.tail<3>().norm(), kSafety.torque_slew * kPeriod * (1 + 1e-9));
    const bool touched = std::exchange(touches_, tick.leaf_pairs > 0);
    if (!touches_) return;
    ++pressed_;
    if (!touched) energy_.meets(velocity);
    energy_.touched((device.work() - work) - (device.damped() - damped),
                    motion_between(before, device.pose()));
  }
  void press_ends() {
    EXPECT_FALSE(touches_) << "it rests in the air";
    energy_.press_ends();
  }
  [[nodiscard]] int pressed() const { return pressed_; }

 private:
  StabilityCase steps_, turns_;
  PressEnergy energy_;
  Vector6 last_ = Vector6::Zero();
  bool touches_ = false;
  int pressed_ = 0;
};

void press_among(Scene scene, const std::string& name, int count) {
  scene.safety = kSafety;
  scene.coupling.stiffness = 1e5;  // clamped to what the device bears
  const BuiltScene built = build_scene(scene);
  Simulation& simulation = *built.simulation;
  const std::vector<RandomPress> presses = random_presses(count);
  HandDevice device = hand_of_presses(presses, simulation.tool_pose());
  const CouplingSettings coupling =
      clamp_coupling(scene.coupling, device.mechanics(), kPeriod).settings;
  ASSERT_LT(coupling.stiffness, scene.coupling.stiffness);
  Felt felt(name, coupling);
  for (int i = 0; i < kTicksToBegin; ++i) felt.tick(simulation, device);
  felt.press_ends();
  int taken = 0, released = 0;
  for (const RandomPress& press : presses) {
    for (int i = 0; i < kTicksOfAPress; ++i) {
      felt.tick(simulation, device);
      if (::testing::Test::HasFatalFailure()) return;
    }
    felt.press_ends();
    if (!press.changes) continue;
    const bool held = simulation.is_held(kLooseBall);
    ASSERT_EQ(held ? simulation.release(kLooseBall) : simulation.attach(kLooseBall),
              ChangeStatus::kDone);
    ++(held ? released : taken);
  }
  EXPECT_GT(felt.pressed(), least(300, 100) * count);
  EXPECT_GT(taken, count / 10);
  EXPECT_GT(released, count / 10);
}

// 20,000 ticks with IST_EFFORT=1, a million with 50. Damping and bodies that yield take energy.
// This could hide energy that the loop gives, so half of the presses are without them.
TEST(AmongFiveBodies, PressesGiveNoEnergyBack) {
  const int count = std::max(2, samples(5));  // the ball is taken, and released
  press_among(five_bodies(Keeps::kSprings), ", among five bodies", count);
  Scene smooth = five_bodies(Keeps::kSprings);
  smooth.damping.reset();
  smooth.springs->stiffness = 1e6;
  press_among(smooth, ", among five smooth bodies", count);
}

}  // namespace
}  // namespace ist::test
