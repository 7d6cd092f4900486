#include "haptics/wall_press.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/sphere_tree.h"
#include "loop/haptics/devices/hand_device.h"
#include "loop/haptics/effects/damping_effect.h"
#include "loop/haptics/effects/springs_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/tool.h"
#include "loop/haptics/wall/wall.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kMillimetre = 1e-3;      // m
constexpr double kStiffContact = 1e6;     // N/m
constexpr double kDamping = 2;            // of the device where it is not pressed, N s/m
constexpr double kAngularDamping = 2e-3;  // N m s/rad
constexpr double kHold = 0.25;            // when motion in the hold counts, s
constexpr double kSkin = 5e-6;            // of a constraint, as in a scene of jaws, m

double leave_of(const PressSettings& settings) { return kHold + settings.hold; }

std::unique_ptr<const SphereTree> tree_of(const TriangleMesh& mesh) {
  BuildOptions options;
  options.voxel_size = 0.5;
  return std::make_unique<const SphereTree>(build_tree(mesh, options));
}

HandSettings hand_against(const PressedWall& wall, const PressSettings& settings) {
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
  return hand;
}

// Well within the border if it is not pressed.
CouplingSettings coupling_of(const PressedWall& wall, const PressSettings& settings) {
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

void add_springs(detail::SimulationParts& parts, const PressedWall& wall,
                 const BodyFrames& frames) {
  detail::add_two_bodies(
      parts, frames, kMillimetre * surface_radius(*wall.held),
      std::make_unique<ToolContactQuery>(*wall.fixed, *wall.held, frames,
                                         ToolContactOptions{.policy = SpherePolicy::kSlab,
                                                            .margin = wall.springs->margin,
                                                            .full_area = wall.springs->full_area}));
  parts.effects.push_back(
      std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = wall.springs->stiffness}));
}

void add_constraint(detail::SimulationParts& parts, const PressedWall& wall,
                    const PressSettings& settings) {
  parts.bodies = HandBodies(
      kMillimetre, press_start(wall),
      {{"fixed", Placement(), wall.fixed->origin(), kMillimetre * surface_radius(*wall.fixed)},
       {"held", Placement(), wall.held->origin(), kMillimetre * surface_radius(*wall.held),
        /*held=*/true}});
  parts.wall.emplace(WallSettings{kSkin, kPressTrust, kPressSteps, settings.friction});
  parts.wall->add({0, 1}, std::make_unique<WallPair>(std::make_shared<WallBody>(*wall.fixed),
                                                     std::make_shared<WallBody>(*wall.held),
                                                     WallPair::Options{}));
  if (settings.contact_damping > 0) {
    parts.effects.push_back(
        std::make_unique<DampingEffect>(DampingSettings{settings.contact_damping}));
  }
}

// The energy of the gaps that a tick's steps ask back at most, J.
double asked_back(const Tick& tick) {
  double energy = 0;
  for (const ContactPoint& point : tick.points) {
    energy += point.normal.dot(point.force) * std::max(0.0, kSkin - point.gap);
  }
  return tick.steps * energy;
}

// Counts the leaks of a run, tick by tick. A tick leaks if the coupling pulls in it, in the tick
// after it, or in the delay before it.
class Account {
 public:
  Account(const PressedWall& wall, const PressSettings& settings)
      : delay_(static_cast<std::size_t>(std::ceil(settings.rate * settings.delay - 1e-6))) {
    const CouplingSettings coupling = coupling_of(wall, settings);
    metric_ << Eigen::Vector3d::Constant(coupling.stiffness),
        Eigen::Vector3d::Constant(coupling.angular_stiffness);
    (wall.turns ? noise_.tail<3>() : noise_.head<3>()).setConstant(0.5 * settings.resolution);
  }

  // A tick in which the tool and then the device made these motions.
  void add(const Vector6& tool, const Vector6& device, const Tick& tick, Energy& energy) {
    constexpr double kPull = 1e-9;  // N and N m
    const bool pulls = tick.wrench.cwiseAbs().maxCoeff() > kPull;
    if (pulls || quiet_ <= delay_) {
      energy.sampled += last_.sampled;
      energy.delayed += last_.delayed;
      energy.feigned += last_.feigned;
    }
    quiet_ = pulls ? 0 : quiet_ + 1;

    Vector6 before = Vector6::Zero();
    for (std::size_t i = 0; i < std::min(delay_, ways_.size()); ++i) {
      before += ways_[ways_.size() - 1 - i];
    }
    ways_.push_back(device);
    last_ = {.sampled = 0.5 * length(device) * length(device),
             .delayed = length(device) * length(before),
             .feigned = noise_.cwiseProduct(metric_).dot(device.cwiseAbs() + tool.cwiseAbs())};
    energy.asked_back += asked_back(tick);
  }

 private:
  [[nodiscard]] double length(const Vector6& motion) const {
    return std::sqrt(motion.cwiseProduct(metric_).dot(motion));
  }

  std::size_t delay_, quiet_ = 0;  // ticks
  Vector6 metric_, noise_ = Vector6::Zero();
  std::vector<Vector6> ways_;
  Energy last_;  // of the last tick
};

PressResult run(const PressedWall& wall, const PressSettings& settings,
                std::vector<Waypoint> plan) {
  const double period = 1 / settings.rate;
  const double damping = std::abs(settings.coupling_damping);
  // For so much of the first tick a wall is not there.
  const double late_stiffness = wall.springs ? settings.stiffness : 0;
  HandSettings hand = hand_against(wall, settings);
  hand.plan = std::move(plan);
  HandDevice device(std::move(hand));
  Simulation simulation = press_simulation(wall, settings);
  Account account(wall, settings);

  PressResult result{};
  double gone = 0;
  Placement tool = simulation.tool_pose();
  while (!device.done()) {
    const Placement before = device.pose();
    const double work = device.work(), damped = device.damped();
    const double speed = wall.way.dot(device.velocity());
    const Tick tick = simulation.tick(device.read(), {});
    device.write(tick.wrench, period);
    const Vector6 way = motion_between(before, device.pose());
    result.most_felt = std::max(result.most_felt, -wall.way.dot(tick.wrench));
    account.add(motion_between(tool, tick.tool), way, tick, result.energy);
    tool = tick.tool;

    const bool contact = tick.leaf_pairs > 0 || !tick.points.empty();
    if (contact && result.touching == 0) {
      result.allowance += (late_stiffness * period + damping) * period * speed * speed;
    }
    result.touching += contact;
    // A wrench is felt for as long as it is delayed after the bodies have parted.
    if (contact || device.work() != work) {
      result.returned += (device.work() - work) - (device.damped() - damped);
      gone += std::abs(wall.way.dot(way));
    }
    const double leave = leave_of(settings), third = settings.hold / 3;
    if (device.time() > kHold && device.time() < kHold + third) {
      result.early = std::max(result.early, std::abs(speed));
    }
    if (device.time() > leave - third && device.time() < leave) {
      result.late = std::max(result.late, std::abs(speed));
    }
  }
  result.allowance += (0.5 * settings.stiffness + damping / period) * settings.resolution * gone +
                      result.energy.asked_back;
  result.energy.work = device.work();
  return result;
}

Vector6 axis(int i, double sign) {
  Vector6 way = Vector6::Zero();
  way[i] = sign;
  return way;
}

std::optional<PressedWall::Springs> springs_if(Stop stop, const PressedWall::Springs& springs) {
  return stop == Stop::kSprings ? std::optional(springs) : std::nullopt;
}

}  // namespace

PressedWall slab_wall(Stop stop) {
  return {tree_of(box({-5, -5, -2}, {5, 5, 0})),
          tree_of(box({-1.5, -1.5, 1}, {1.5, 1.5, 3})),
          false,
          axis(2, -1),
          5e-3,
          springs_if(stop, {kStiffContact})};
}

PressedWall stop_wall(Stop stop) {
  const TriangleMesh ball = icosphere(3, 3);
  return {tree_of(joined(box({10, -5, -6}, {20, 5, -4}), box({-20, -5, 4}, {-10, 5, 6}))),
          tree_of(joined(moved(ball, {15, 0, 0}), moved(ball, {-15, 0, 0}))),
          true,
          axis(4, 1),
          0.25,
          springs_if(stop, {kStiffContact})};
}

PressedWall tip_wall(Stop stop) {
  return {tree_of(box({-5, -5, -2}, {5, 5, 0})),
          tree_of(moved(icosphere(3, 1), {0, 0, 2})),
          false,
          axis(2, -1),
          5e-3,
          springs_if(stop, {SpringsSettings().stiffness, 0, 12.0 / (160 * 160) / (0.5 * 0.5)})};
}

PressedWall edge_wall() {
  // A block with an edge along x on top, and one with an edge along y below.
  const double kHalf = std::sqrt(0.5);
  Eigen::Matrix3d about_x, about_y;
  about_x << 1, 0, 0, 0, kHalf, -kHalf, 0, kHalf, kHalf;
  about_y << kHalf, 0, kHalf, 0, 1, 0, -kHalf, 0, kHalf;
  const double side = 2, top = side * std::sqrt(0.5);
  const TriangleMesh fixed = box({-5, -1, -1}, {5, 1, 1}), held = box({-1, -5, -1}, {1, 5, 1});
  return {tree_of(moved(turned(fixed, about_x), {0, 0, -top})),
          tree_of(moved(turned(held, about_y), {0, 0, top + 1})),
          false,
          axis(2, -1),
          5e-3,
          std::nullopt};
}

Placement press_start(const PressedWall& wall) {
  return {Eigen::Matrix3d::Identity(), kMillimetre * wall.held->origin()};
}

Simulation press_simulation(const PressedWall& wall, const PressSettings& settings) {
  const BodyFrames frames{kMillimetre, Placement(), wall.held->origin()};
  // Nothing but the coupling shapes the wrench.
  constexpr SafetySettings kOpen{1e4, 100, 1e9, 1e7, 0};
  detail::SimulationParts parts{.coupling = coupling_of(wall, settings),
                                .safety = kOpen,
                                .max_step = kMillimetre * wall.held->voxel_size(),
                                .start = press_start(wall),
                                .dt = 1 / settings.rate};
  if (wall.springs) {
    add_springs(parts, wall, frames);
  } else {
    add_constraint(parts, wall, settings);
  }
  return detail::simulation_from(std::move(parts));
}

PressResult press(const PressedWall& wall, const PressSettings& settings) {
  const Placement start = press_start(wall), pressed = start.moved(wall.reach * wall.way);
  const double leave = leave_of(settings);
  return run(
      wall, settings,
      {{0, start}, {0.2, pressed}, {leave, pressed}, {leave + 0.1, start}, {leave + 0.2, start}});
}

PressResult wander(const PressedWall& wall, const PressSettings& settings,
                   const std::vector<Vector6>& poses, double seconds) {
  const Placement start = press_start(wall);
  std::vector<Waypoint> plan = {{0, start}};
  for (const Vector6& pose : poses) {
    plan.push_back({plan.back().time + seconds, start.moved(pose)});
  }
  // The hand swings until its damping has brought it to rest.
  plan.push_back({plan.back().time + seconds, start});
  plan.push_back({plan.back().time + 3, start});
  return run(wall, settings, std::move(plan));
}

double measured_border(const PressedWall& wall, PressSettings settings, double about) {
  double passive = 0.5 * about, active = 4 * about;
  while (active > 1.02 * passive) {
    settings.stiffness = std::sqrt(passive * active);
    (press(wall, settings).active() ? active : passive) = settings.stiffness;
  }
  return active;
}

}  // namespace ist::test
