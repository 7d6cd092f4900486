#include "loop/scene/make_effects.h"

#include "loop/haptics/effects/damping_effect.h"
#include "loop/haptics/effects/gravity_effect.h"
#include "loop/haptics/effects/proximity_effect.h"
#include "loop/haptics/effects/snap_effect.h"
#include "loop/haptics/effects/springs_effect.h"

namespace ist {

std::vector<std::unique_ptr<Effect>> make_effects(const Scene& scene, const BodyHome& home,
                                                  bool contacts) {
  std::vector<std::unique_ptr<Effect>> effects;
  if (scene.springs && contacts) {
    effects.push_back(std::make_unique<SpringsEffect>(*scene.springs));
  }
  if (scene.damping && contacts) {
    effects.push_back(std::make_unique<DampingEffect>(*scene.damping));
  }
  if (scene.proximity && contacts) {
    effects.push_back(std::make_unique<ProximityEffect>(*scene.proximity));
  }
  if (scene.gravity) {
    const SceneGravity& gravity = *scene.gravity;
    const Eigen::Vector3d centre =
        scene.unit * (gravity.centre.value_or(home.origin) - home.origin);
    effects.push_back(std::make_unique<GravityEffect>(
        GravitySettings{gravity.mass, centre, gravity.acceleration}));
  }
  if (scene.snap) {
    SnapSettings snap = *scene.snap;
    snap.pose = home.moved(snap.pose);
    effects.push_back(std::make_unique<SnapEffect>(snap));
  }
  return effects;
}

EffectNeeds needs_of(const std::vector<std::unique_ptr<Effect>>& effects) noexcept {
  EffectNeeds needs;
  for (const auto& effect : effects) needs |= effect->needs();
  return needs;
}

}  // namespace ist
