#include "haptics/wall_press.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/sphere_tree.h"
#include "loop/haptics/devices/hand_device.h"
#include "loop/haptics/effects/springs_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/tool.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kMillimetre = 1e-3;          // m
constexpr double kStiffContact = 1e6;         // N/m
constexpr double kDamping = 2;                // of the device where it is not pressed, N s/m
constexpr double kAngularDamping = 2e-3;      // N m s/rad
constexpr double kHold = 0.25, kLeave = 0.6;  // s

std::unique_ptr<const SphereTree> tree_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = 0.5;
  return std::make_unique<const SphereTree>(build_tree(mesh, options));
}

Placement start_of(const Wall& wall) {
  return {Eigen::Matrix3d::Identity(), kMillimetre * wall.held->origin()};
}

HandSettings hand_against(const Wall& wall, const PressSettings& settings) {
  HandSettings hand{};
  hand.mechanics = {.damping = wall.turns ? kDamping : settings.damping,
                    .angular_damping = wall.turns ? settings.damping : kAngularDamping,
                    .delay = settings.delay};
  hand.mass = 0.1;
  hand.inertia = 1e-4;
  hand.arm_stiffness = 500;
  hand.arm_angular_stiffness = 0.5;
  hand.arm_damping = hand.arm_angular_damping = 0;
  (wall.turns ? hand.angular_resolution : hand.resolution) = settings.resolution;
  const Placement start = start_of(wall), pressed = start.moved(wall.reach * wall.way);
  hand.plan = {{0, start}, {0.2, pressed}, {kLeave, pressed}, {0.7, start}, {0.8, start}};
  return hand;
}

// Well within the border where it is not pressed.
CouplingSettings coupling_of(const Wall& wall, const PressSettings& settings) {
  const double lag = 0.5 / settings.rate + settings.delay;
  CouplingSettings coupling{.stiffness = 0.4 * kDamping / lag,
                            .damping = 0,
                            .angular_stiffness = 0.4 * kAngularDamping / lag,
                            .angular_damping = 0,
                            .max_force = 1000,
                            .max_torque = 10};
  (wall.turns ? coupling.angular_stiffness : coupling.stiffness) = settings.stiffness;
  (wall.turns ? coupling.angular_damping : coupling.damping) = settings.coupling_damping;
  return coupling;
}

Simulation simulation_of(const Wall& wall, const PressSettings& settings) {
  const BodyFrames frames{kMillimetre, Placement(), wall.held->origin()};
  // Nothing but the coupling shapes the wrench.
  constexpr SafetySettings kOpen{1e4, 100, 1e9, 1e7, 0};
  detail::SimulationParts parts{.coupling = coupling_of(wall, settings),
                                .safety = kOpen,
                                .max_step = kMillimetre * wall.held->voxel_size(),
                                .start = start_of(wall),
                                .dt = 1 / settings.rate};
  detail::add_two_bodies(
      parts, frames, kMillimetre * surface_radius(*wall.held),
      std::make_unique<ToolContactQuery>(
          *wall.fixed, *wall.held, frames,
          ToolContactOptions{
              .policy = SpherePolicy::kSlab, .margin = wall.margin, .full_area = wall.full_area}));
  parts.effects.push_back(
      std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = wall.contact_stiffness}));
  return detail::simulation_from(std::move(parts));
}

Vector6 axis(int i, double sign) {
  Vector6 way = Vector6::Zero();
  way[i] = sign;
  return way;
}

}  // namespace

Wall slab_wall() {
  return {tree_of(box({-5, -5, -2}, {5, 5, 0})),
          tree_of(box({-1.5, -1.5, 1}, {1.5, 1.5, 3})),
          false,
          axis(2, -1),
          5e-3,
          kStiffContact};
}

Wall stop_wall() {
  const TriangleMesh ball = icosphere(3, 3);
  return {tree_of(joined(box({10, -5, -6}, {20, 5, -4}), box({-20, -5, 4}, {-10, 5, 6}))),
          tree_of(joined(moved(ball, {15, 0, 0}), moved(ball, {-15, 0, 0}))),
          true,
          axis(4, 1),
          0.25,
          kStiffContact};
}

Wall tip_wall() {
  return {tree_of(box({-5, -5, -2}, {5, 5, 0})),
          tree_of(moved(icosphere(3, 1), {0, 0, 2})),
          false,
          axis(2, -1),
          5e-3,
          SpringsSettings().stiffness,
          0,
          12.0 / (160 * 160) / (0.5 * 0.5)};
}

PressResult press(const Wall& wall, const PressSettings& settings) {
  const double period = 1 / settings.rate;
  const double damping = std::abs(settings.coupling_damping);
  HandDevice device(hand_against(wall, settings));
  Simulation simulation = simulation_of(wall, settings);

  PressResult result{};
  double early = 0, late = 0, gone = 0;
  bool touched = false;
  while (!device.done()) {
    const Placement before = device.pose();
    const double work = device.work(), damped = device.damped();
    const double speed = wall.way.dot(device.velocity());
    const Tick tick = simulation.tick(device.read(), {});
    device.write(tick.wrench, period);
    result.most_felt = std::max(result.most_felt, -wall.way.dot(tick.wrench));

    const bool contact = tick.leaf_pairs > 0;
    if (contact && !touched) {
      result.allowance += (settings.stiffness * period + damping) * period * speed * speed;
    }
    touched = touched || contact;
    // A wrench is felt for as long as it is delayed after the bodies have parted.
    if (contact || device.work() != work) {
      result.returned += (device.work() - work) - (device.damped() - damped);
      gone += std::abs(wall.way.dot(motion_between(before, device.pose())));
    }
    constexpr double kThird = (kLeave - kHold) / 3;
    if (device.time() > kHold && device.time() < kHold + kThird) {
      early = std::max(early, std::abs(speed));
    }
    if (device.time() > kLeave - kThird && device.time() < kLeave) {
      late = std::max(late, std::abs(speed));
    }
  }
  result.allowance += (0.5 * settings.stiffness + damping / period) * settings.resolution * gone;
  result.growth = late / early;
  return result;
}

double measured_border(const Wall& wall, PressSettings settings, double about) {
  double passive = 0.5 * about, active = 4 * about;
  while (active > 1.02 * passive) {
    settings.stiffness = std::sqrt(passive * active);
    (press(wall, settings).active() ? active : passive) = settings.stiffness;
  }
  return active;
}

}  // namespace ist::test
