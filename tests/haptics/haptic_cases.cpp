#include "haptics/haptic_cases.h"

#include "ist/tree/sphere_tree.h"
#include "loop/haptics/effects/springs_effect.h"
#include "loop/haptics/simulation_parts.h"
#include "loop/haptics/tool.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

SphereTree haptic_tree(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  return build_tree(mesh, options);
}

}  // namespace

Simulation HapticBodies::simulation(std::unique_ptr<Effect> other) const {
  const BodyFrames frames{1e-3, Placement(), held_->origin()};
  detail::SimulationParts parts{.coupling = kHapticCoupling,
                                .safety = kHapticSafety,
                                .max_step = voxel(),
                                .start = at(1e-3),
                                .dt = 1e-3};
  detail::add_two_bodies(
      parts, frames, 1e-3 * surface_radius(*held_),
      std::make_unique<ToolContactQuery>(*fixed_, *held_, frames,
                                         ToolContactOptions{SpherePolicy::kSlab, 0.5}));
  parts.effects.push_back(std::make_unique<SpringsEffect>(SpringsSettings{.stiffness = 20000}));
  if (other) parts.effects.push_back(std::move(other));
  return detail::simulation_from(std::move(parts));
}

HapticBodies ball_over_box() {
  SphereTree held = haptic_tree(icosphere(4, 5), 0.5);
  const double touching = 1e-3 * (5 + held.origin().z());
  return {haptic_tree(box({-10, -10, -4}, {10, 10, 0}), 0.5), std::move(held), touching};
}

}  // namespace ist::test
