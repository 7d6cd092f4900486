#include <fmt/format.h>

#include <algorithm>

#include "ist/scene/ranges.h"
#include "ist/scene/scene_parts.h"

namespace ist {
namespace {

FrictionSettings read_friction(TableReader friction) {
  FrictionSettings settings = read_numbers(friction, kFrictionKeys);
  if (!friction.has("dynamic")) {
    settings.dynamic_coefficient =
        std::min(settings.dynamic_coefficient, settings.static_coefficient);
  }
  if (settings.dynamic_coefficient > settings.static_coefficient) {
    friction.fail("dynamic",
                  fmt::format("'dynamic' is {}, more than 'static', which is {}",
                              settings.dynamic_coefficient, settings.static_coefficient),
                  "lower it: friction falls as sliding begins");
  }
  return settings;
}

SceneGravity read_gravity(TableReader gravity) {
  SceneGravity settings;
  settings.mass = gravity.number("mass", kMass);
  if (gravity.has("centre")) settings.centre = gravity.vector("centre", kPlace);
  settings.acceleration = gravity.vector("acceleration", kAcceleration, settings.acceleration);
  return settings;
}

SnapSettings read_snap(TableReader snap, double unit) {
  SnapSettings settings = read_numbers(snap, kSnapKeys);
  settings.pose.rotation = snap.rotation("turn");
  settings.pose.translation = unit * snap.vector("move", kPlace, Eigen::Vector3d::Zero());
  settings.radius = unit * snap.number("radius", kLength);
  return settings;
}

}  // namespace

void read_effects(TableReader& scene, Scene& result) {
  if (!scene.has("effects")) return;
  TableReader effects = scene.table("effects");
  if (effects.has("contact")) {
    result.contact = read_numbers(effects.table("contact"), kContactKeys);
  }
  if (effects.has("friction")) result.friction = read_friction(effects.table("friction"));
  if (effects.has("damping")) {
    result.damping = DampingSettings{
        .damping = effects.table("damping").number("damping", kDamping, DampingSettings().damping)};
  }
  if (effects.has("proximity")) {
    TableReader proximity = effects.table("proximity");
    result.proximity = {
        .distance = result.unit * proximity.number("distance", kLength),
        .damping = proximity.number("damping", kDamping, ProximitySettings().damping)};
  }
  if (effects.has("gravity")) result.gravity = read_gravity(effects.table("gravity"));
  if (effects.has("snap")) result.snap = read_snap(effects.table("snap"), result.unit);
}

}  // namespace ist
