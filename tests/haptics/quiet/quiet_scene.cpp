#include "haptics/quiet/quiet_scene.h"

namespace ist::test {

Scene scene_with_all_effects() {
  using Kind = BuiltInShape::Kind;
  const auto waypoint = [](double time, double x, double z) {
    return Waypoint{time, {Eigen::Matrix3d::Identity(), 1e-3 * Eigen::Vector3d(x, 0, z)}};
  };
  Scene scene{};
  scene.file = "scene.toml";
  scene.unit = 1e-3;
  scene.fixed.front().source =
      BuiltInShape{.kind = Kind::kBox, .size = Eigen::Vector3d(40, 40, 10)};
  scene.fixed.front().voxel_size = 1;
  scene.held.front().source = BuiltInShape{.kind = Kind::kSphere, .radius = 5};
  scene.held.front().voxel_size = 0.5;
  scene.held.front().translation = {0, 0, 11};
  HandSettings hand{};
  hand.mechanics = {2, 2e-3, 0};
  hand.mass = 0.2;
  hand.inertia = 2e-4;
  hand.arm_stiffness = 500;
  hand.arm_damping = 10;
  hand.arm_angular_stiffness = 1;
  hand.arm_angular_damping = 0.02;
  hand.plan = {waypoint(0, 0, 0), waypoint(0.3, 0, -3), waypoint(0.8, 5, -3)};
  scene.device = hand;
  scene.coupling = {1000, 0.5, 1, 5e-4, 5, 0.2};
  scene.safety = {8, 0.3, 500, 20, 0.1};
  scene.contact = ContactSettings{2000, 0.5};
  scene.friction = FrictionSettings{0.3, 0.2, 1000};
  scene.damping = DampingSettings{1};
  scene.proximity = ProximitySettings{2e-3, 2};
  scene.gravity = SceneGravity{0.05, std::nullopt, {0, 0, -9.81}};
  scene.snap = SnapSettings{{Eigen::Matrix3d::Identity(), {5e-3, 0, -1e-3}}, 200, 0.2, 5e-3, 0.2};
  return scene;
}

}  // namespace ist::test
