#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "haptics/human_pair.h"
#include "loop/haptics/stability_border.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/stability.h"

namespace ist::test {
namespace {

// Some 2.5 times as fast as the plan, m/s and rad/s.
constexpr double kFastest = 0.03, kFastestTurn = 0.6;

// Neither force nor torque leaps, and nothing is at fault.
class Steadiness {
 public:
  explicit Steadiness(const std::string& name)
      : steps_("long runs", "force from tick to tick" + name, "N"),
        turns_("long runs", "torque from tick to tick" + name, "N m"),
        speed_("long runs", "speed of a hand that presses" + name, "m/s"),
        spin_("long runs", "turning of a hand that presses" + name, "rad/s") {}

  // Of a tick, and of the hand after it.
  void check(const Tick& tick, const Vector6& velocity) {
    ASSERT_TRUE(tick.wrench.allFinite() && tick.tool.translation.allFinite() &&
                tick.tool.rotation.allFinite());
    ASSERT_FALSE(tick.fault || tick.held);
    const Vector6 step = tick.wrench - last_;
    last_ = tick.wrench;
    steps_.sample(step.head<3>().norm(), kSafety.force_slew * kPeriod * (1 + 1e-9));
    turns_.sample(step.tail<3>().norm(), kSafety.torque_slew * kPeriod * (1 + 1e-9));
    speed_.sample(velocity.head<3>().norm(), kFastest);
    spin_.sample(velocity.tail<3>().norm(), kFastestTurn);
  }

 private:
  StabilityCase steps_, turns_, speed_, spin_;
  Vector6 last_ = Vector6::Zero();
};

// The force trembles by less than this part of it while the hand rests on the other jaw.
constexpr double kStill = 0.01;
// Of 1,200 presses with voxels of 0.8 mm six are not still, the worst by 3.1 %: the tool's steps
// circle round the balance where few pairs bear it (perf/NOTES.md). The same presses give the same
// forces, but for sines of the platform's library, for which the rest is.
constexpr double kCircling = 0.033;

// Whether no more presses tremble than may: one in a hundred, rounded up, and of two none.
bool are_few(int trembling, int presses) {
  return trembling <= (presses > 2 ? (presses + 99) / 100 : 0);
}

// The force is still while the hand rests on the other jaw.
class Stillness {
 public:
  // `all_still`: no press may circle.
  Stillness(const std::string& name, bool all_still)
      : noise_("long runs", "force at rest" + name, "part of it that trembles"),
        most_noise_(all_still ? kStill : kCircling) {}

  void check(const Tick& tick, double time_of_press) {
    if (time_of_press <= kRestBegins || time_of_press >= kRestEnds) return;
    least_ = std::min(least_, tick.wrench.head<3>().norm());
    most_ = std::max(most_, tick.wrench.head<3>().norm());
  }
  void press_ends() {
    // Below it, the flicker of one count of the encoders in each direction, 5 mN, is 1 % of it.
    EXPECT_GT(least_, 0.6) << "N: hardly pressed";
    const double trembles = (most_ - least_) / most_;
    noise_.sample(trembles, most_noise_);
    ++presses_;
    trembling_ += trembles > kStill ? 1 : 0;
    EXPECT_TRUE(are_few(trembling_, presses_)) << trembling_ << " of " << presses_ << " tremble";
    least_ = 1e300;
    most_ = 0;
  }

 private:
  StabilityCase noise_;
  double most_noise_;
  int presses_ = 0, trembling_ = 0;
  double least_ = 1e300, most_ = 0;
};

// `give`: the surfaces come apart when the tool is moved so far out, m. The springs of a contact
// begin a margin before surfaces meet, and give way by what they bear.
void press_for(double voxel_size, double give, int count) {
  HumanPair pair(voxel_size);
  HandDevice device(hand_of(presses(pair, count)));
  const CouplingSettings coupling =
      clamp_coupling({1000, 0.5, 1, 5e-4, 5, 0.2}, device.mechanics(), kPeriod).settings;
  Simulation simulation = pair.simulation(coupling);
  const std::string name = ", voxels of " + std::to_string(voxel_size);
  Steadiness steadiness(name);
  Stillness stillness(name, count <= 2);
  PressEnergy energy(name, coupling);
  int looked = 0;
  for (int i = 0; i < count; ++i) {
    for (int ticks = 0; ticks < kPressTicks; ++ticks) {
      const Placement before = device.pose();
      const double work = device.work(), damped = device.damped();
      const Tick tick = simulation.tick(device.read(), {});
      device.write(tick.wrench, kPeriod);
      steadiness.check(tick, device.velocity());
      if (::testing::Test::HasFatalFailure()) return;
      stillness.check(tick, ticks * kPeriod);
      if (tick.leaf_pairs > 0 || device.work() != work) {
        energy.touched((device.work() - work) - (device.damped() - damped),
                       motion_between(before, device.pose()));
      }
      if (ticks % 100 == 0 && tick.leaf_pairs > 0) {
        ++looked;
        Placement out = tick.tool;
        out.translation.z() -= give;
        EXPECT_FALSE(pair.surfaces_meet(out)) << "press " << i << ", tick " << ticks;
      }
    }
    stillness.press_ends();
    energy.press_ends();
  }
  EXPECT_GT(looked, 5 * count);
}

// A leaf's ball is no wider, m: a voxel's diagonal. A surface that lies deeper in the other body is
// in none of the balls that hold the other surface. Of 1,200 presses with voxels of 0.2 mm, whose
// diagonal is 0.346 mm, the deepest (at 1.6 N) needs 0.302 mm.
double widest_ball(double voxel_size) { return std::sqrt(3.0) * 1e-3 * voxel_size; }

// Two presses with IST_EFFORT=1. With 600 it is an hour, with voxels of either size.
TEST(LongPressing, OfTheHumanPairGivesNoEnergyAndRestsStill) {
  IST_SLOW();
  if (!HumanPair::is_there()) IST_SKIP("the scans of the human jaws are not in " << data_dir());
  const int count = samples(2);
  press_for(0.8, 0, count);
  if (count > 2) press_for(0.2, widest_ball(0.2), count);
}

}  // namespace
}  // namespace ist::test
