#include "haptics/human_pair.h"

#include <filesystem>

#include "ist/mesh/mesh.h"
#include "loop/haptics/effects/damping_effect.h"
#include "loop/haptics/effects/springs_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/tool.h"
#include "support/data_dir.h"
#include "support/random.h"

namespace ist::test {
namespace {

constexpr const char *kUpper = "human_maxilla.stl", *kLower = "human_mandible.stl";
constexpr double kMargin = 0.25;        // from which springs begin, voxels
const Eigen::Vector3d kOpen(0, 0, -4);  // mm

SphereTree tree_of_file(const char* file, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.keep_triangles = true;
  return build_tree(read_mesh(data_dir() / file), options);
}

}  // namespace

bool HumanPair::is_there() {
  return std::filesystem::exists(data_dir() / kUpper) &&
         std::filesystem::exists(data_dir() / kLower);
}

HumanPair::HumanPair(double voxel_size)
    : fixed_(tree_of_file(kUpper, voxel_size)),
      held_(tree_of_file(kLower, voxel_size)),
      frames_{1e-3, Placement(), held_.origin()},
      exact_(fixed_, held_) {}

Placement HumanPair::moved(const Eigen::Vector3d& millimetres, const Eigen::Vector3d& turn) const {
  Vector6 motion;
  motion << 1e-3 * millimetres, turn;
  const Placement by = Placement().moved(motion);
  return {by.rotation, by.translation + 1e-3 * frames_.tool_origin};
}

bool HumanPair::surfaces_meet(const Placement& tool) {
  return exact_.intersects(frames_.query_pose(tool)).answer == Answer::kYes;
}

Simulation HumanPair::simulation(const CouplingSettings& coupling) const {
  const double voxel = 1e-3 * held_.voxel_size();
  detail::SimulationParts parts{.coupling = coupling,
                                .safety = kSafety,
                                .max_step = voxel,
                                .start = moved(kOpen),
                                .dt = kPeriod};
  detail::add_two_bodies(
      parts, frames_, 1e-3 * surface_radius(held_),
      std::make_unique<ToolContactQuery>(fixed_, held_, frames_,
                                         ToolContactOptions{SpherePolicy::kSlab, kMargin}));
  parts.effects.push_back(std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = 20000}));
  parts.effects.push_back(std::make_unique<DampingEffect>(DampingSettings{10}));
  return detail::simulation_from(std::move(parts));
}

std::vector<Waypoint> presses(const HumanPair& pair, int count) {
  Random random(61);
  std::vector<Waypoint> plan{{0, pair.moved(kOpen)}};
  for (int i = 0; i < count; ++i) {
    const double begin = kPressTicks * kPeriod * i;
    const double depth = random.uniform(3.5, 5.5);
    const auto place = [&] {
      Eigen::Vector3d way = random.point(-0.5, 0.5);
      way.z() = depth;
      return pair.moved(way, random.point(-0.02, 0.02));
    };
    const Placement first = place(), second = place();
    plan.push_back({begin + 0.7, first});
    plan.push_back({begin + 1.0, first});
    plan.push_back({begin + 1.4, second});
    plan.push_back({begin + kRestEnds, second});
    plan.push_back({begin + 2.7, pair.moved(kOpen)});
    plan.push_back({begin + kPressTicks * kPeriod, pair.moved(kOpen)});
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

}  // namespace ist::test
