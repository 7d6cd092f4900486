#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ist/haptics/devices/hand_device.h"
#include "ist/haptics/effects/damping_effect.h"
#include "ist/haptics/effects/friction_effect.h"
#include "ist/haptics/simulation_parts.h"
#include "ist/haptics/stability_border.h"
#include "ist/haptics/tool.h"
#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "support/data_dir.h"
#include "support/random.h"
#include "support/skip.h"
#include "support/stability.h"

namespace ist::test {
namespace {

constexpr double kPeriod = 1e-3;              // s
constexpr int kTicks = 3000;                  // of one press: come, slide, rest, go
constexpr double kPress = kTicks * kPeriod;   // s
constexpr double kRest = 1.9, kRested = 2.1;  // s: within it nothing is planned to move
constexpr double kResolution = 2e-6, kAngularResolution = 2e-5;  // of the encoders, m and rad
// Some 2.5 times as fast as the plan, m/s and rad/s.
constexpr double kFastest = 0.03, kFastestTurn = 0.6;
constexpr double kMargin = 0.25;  // from which springs begin, voxels
constexpr SafetySettings kSafety{8, 0.3, 500, 20, 0.5};

Placement at(const Eigen::Vector3d& millimetres, const Eigen::Vector3d& turn = {0, 0, 0}) {
  Vector6 motion;
  motion << 1e-3 * millimetres, turn;
  return Placement().moved(motion);
}

// The human pair: the lower jaw is held. As stored it stands in full occlusion, and opens along -z.
class HumanPair {
 public:
  explicit HumanPair(double voxel_size)
      : fixed_(tree("human_maxilla.stl", voxel_size)),
        held_(tree("human_mandible.stl", voxel_size)),
        frames_{1e-3, Placement(), held_.origin()},
        exact_(fixed_, held_) {}

  [[nodiscard]] Placement home() const {
    return {Eigen::Matrix3d::Identity(), 1e-3 * frames_.tool_origin};
  }
  // After a motion from where it is stored.
  [[nodiscard]] Placement moved(const Placement& by) const {
    return {by.rotation, by.translation + home().translation};
  }
  [[nodiscard]] double voxel() const { return 1e-3 * held_.voxel_size(); }
  [[nodiscard]] bool surfaces_meet(const Placement& tool) {
    return exact_.intersects(frames_.query_pose(tool)).answer == Answer::kYes;
  }
  [[nodiscard]] Simulation simulation(const CouplingSettings& coupling) const {
    detail::SimulationParts parts{
        std::make_unique<ToolContactQuery>(fixed_, held_, frames_,
                                           ToolContactOptions{SpherePolicy::kSlab, -kMargin}),
        nullptr,
        {},
        coupling,
        kSafety,
        Tool(1e-3 * surface_radius(held_), voxel()),
        moved(at({0, 0, -4})),
        kPeriod};
    auto contact = std::make_unique<ContactEffect>(ContactSettings{2000, kMargin});
    const ContactEffect& load = *contact;
    parts.effects.push_back(std::move(contact));
    parts.effects.push_back(
        std::make_unique<FrictionEffect>(FrictionSettings{0.3, 0.2, 1000}, load));
    parts.effects.push_back(std::make_unique<DampingEffect>(DampingSettings{1}));
    return Simulation(std::move(parts));
  }

 private:
  static SphereTree tree(const char* file, double voxel_size) {
    BuildOptions options;
    options.voxel_size = voxel_size;
    options.keep_triangles = true;
    return build_tree(read_mesh(data_dir() / file), options);
  }
  SphereTree fixed_, held_;
  BodyFrames frames_;
  Query exact_;
};

// Presses one after the other, each to another place and with another turn.
std::vector<Waypoint> presses(const HumanPair& pair, int count) {
  Random random(61);
  std::vector<Waypoint> plan{{0, pair.moved(at({0, 0, -4}))}};
  for (int i = 0; i < count; ++i) {
    const double begin = kPress * i;
    const double depth = random.uniform(3.5, 5.5);
    const auto place = [&] {
      Eigen::Vector3d way = random.point(-0.5, 0.5);
      way.z() = depth;
      return at(way, random.point(-0.02, 0.02));
    };
    const Placement first = pair.moved(place()), second = pair.moved(place());
    plan.push_back({begin + 0.7, first});
    plan.push_back({begin + 1.0, first});
    plan.push_back({begin + 1.4, second});
    plan.push_back({begin + kRested, second});
    plan.push_back({begin + 2.7, pair.moved(at({0, 0, -4}))});
    plan.push_back({begin + kPress, pair.moved(at({0, 0, -4}))});
  }
  return plan;
}

HandSettings hand_of(std::vector<Waypoint> plan) {
  return {.mechanics = {.damping = 2, .angular_damping = 2e-3, .delay = 0},
          .mass = 0.2,
          .inertia = 2e-4,
          .arm_stiffness = 500,
          .arm_damping = 10,
          .arm_angular_stiffness = 1,
          .arm_angular_damping = 0.02,
          .resolution = kResolution,
          .angular_resolution = kAngularResolution,
          .plan = std::move(plan)};
}

// What a press must be within.
class Watch {
 public:
  Watch(const CouplingSettings& coupling, double voxel_size)
      : coupling_(coupling), name_(", voxels of " + std::to_string(voxel_size)) {}

  void tick(const Tick& tick, double time) {
    ASSERT_TRUE(tick.wrench.allFinite() && tick.tool.translation.allFinite() &&
                tick.tool.rotation.allFinite());
    ASSERT_FALSE(tick.fault || tick.held);
    const Vector6 step = tick.wrench - last_;
    last_ = tick.wrench;
    steps_.sample(step.head<3>().norm(), kSafety.force_slew * kPeriod * (1 + 1e-9));
    turns_.sample(step.tail<3>().norm(), kSafety.torque_slew * kPeriod * (1 + 1e-9));
    if (time > kRest && time < kRested) {
      least_ = std::min(least_, tick.wrench.head<3>().norm());
      most_ = std::max(most_, tick.wrench.head<3>().norm());
    }
  }
  // The hand's part of a tick in which something was touched: for the energy, as in PressResult.
  void touched(double returned, const Vector6& way) {
    returned_ += returned;
    allowance_ += (0.5 * coupling_.stiffness + coupling_.damping / kPeriod) * kResolution *
                      way.head<3>().norm() +
                  (0.5 * coupling_.angular_stiffness + coupling_.angular_damping / kPeriod) *
                      kAngularResolution * way.tail<3>().norm();
  }
  void moving(const Vector6& velocity) {
    speed_.sample(velocity.head<3>().norm(), kFastest);
    spin_.sample(velocity.tail<3>().norm(), kFastestTurn);
  }
  void press_ends() {
    // Below it, the flicker of one count of the encoders in each direction, 5 mN, is 1 % of it.
    EXPECT_GT(least_, 0.6) << "N: hardly pressed";
    // Still is less than 1 %. With voxels of 0.8 mm one press in 200 is not, by up to 3.1 %: the
    // tool's steps circle round the balance where few pairs bear it (perf/NOTES.md).
    const double trembles = (most_ - least_) / most_;
    noise_.sample(trembles, 0.04);
    ++presses_;
    trembling_ += trembles > 0.01 ? 1 : 0;
    EXPECT_LE(100 * trembling_, presses_ + 99 * (presses_ > 2 ? 1 : 0));
    energy_.sample(std::max(0.0, returned_), allowance_);
    least_ = 1e300;
    most_ = returned_ = allowance_ = 0;
  }

 private:
  CouplingSettings coupling_;
  std::string name_;
  StabilityCase steps_{"long runs", "force from tick to tick" + name_, "N"};
  StabilityCase turns_{"long runs", "torque from tick to tick" + name_, "N m"};
  StabilityCase speed_{"long runs", "speed of a hand that presses" + name_, "m/s"};
  StabilityCase spin_{"long runs", "turning of a hand that presses" + name_, "rad/s"};
  StabilityCase noise_{"long runs", "force at rest" + name_, "part of it that trembles"};
  StabilityCase energy_{"long runs", "energy returned by a press" + name_, "J"};
  int presses_ = 0, trembling_ = 0;
  Vector6 last_ = Vector6::Zero();
  double least_ = 1e300, most_ = 0, returned_ = 0, allowance_ = 0;
};

// `give`: the surfaces come apart when the tool is moved so far out, m. The springs of a contact
// begin a margin before surfaces meet, and give way by what they bear.
void press_for(double voxel_size, double give, int count) {
  HumanPair pair(voxel_size);
  HandDevice device(hand_of(presses(pair, count)));
  const CouplingSettings coupling =
      clamp_coupling({1000, 0.5, 1, 5e-4, 5, 0.2}, device.mechanics(), kPeriod).settings;
  Simulation simulation = pair.simulation(coupling);
  Watch watch(coupling, voxel_size);
  int looked = 0;
  for (int i = 0; i < count; ++i) {
    for (int ticks = 0; ticks < kTicks; ++ticks) {
      const Placement before = device.pose();
      const double work = device.work(), damped = device.damped();
      const Tick tick = simulation.tick(device.read(), {});
      device.write(tick.wrench, kPeriod);
      watch.tick(tick, ticks * kPeriod);
      if (::testing::Test::HasFatalFailure()) return;
      watch.moving(device.velocity());
      if (tick.leaf_pairs > 0 || device.work() != work) {
        watch.touched((device.work() - work) - (device.damped() - damped),
                      motion_between(before, device.pose()));
      }
      if (ticks % 100 == 0 && tick.leaf_pairs > 0) {
        ++looked;
        Placement out = tick.tool;
        out.translation.z() -= give;
        EXPECT_FALSE(pair.surfaces_meet(out)) << "press " << i << ", tick " << ticks;
      }
    }
    watch.press_ends();
  }
  EXPECT_GT(looked, 5 * count);
}

// Two presses by default; with IST_EFFORT=600 an hour, with voxels of either size.
TEST(LongPressing, OfTheHumanPairGivesNoEnergyAndRestsStill) {
  for (const char* file : {"human_maxilla.stl", "human_mandible.stl"}) {
    if (!std::filesystem::exists(data_dir() / file)) IST_SKIP(data_dir() / file << " is not there");
  }
  const int count = samples(2);
  press_for(0.8, 0, count);
  if (count > 2) press_for(0.2, 3e-4, count);
}

}  // namespace
}  // namespace ist::test
