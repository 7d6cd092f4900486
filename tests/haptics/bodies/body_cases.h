#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ist/scene.h"

namespace ist::test {

/// Of a device that the test moves.
inline constexpr DeviceMechanics kDeviceUnderTest{.damping = 2, .angular_damping = 2e-3};

/// A box of a scene, in millimetres, between two corners.
[[nodiscard]] inline SceneBody box_body(std::string name, const Eigen::Vector3d& min,
                                        const Eigen::Vector3d& max, double voxel_size = 1) {
  SceneBody body;
  body.name = std::move(name);
  body.source = BuiltInShape{.kind = BuiltInShape::Kind::kBox, .size = max - min};
  body.voxel_size = voxel_size;
  body.translation = 0.5 * (min + max);
  return body;
}

[[nodiscard]] inline SceneBody ball_body(std::string name, const Eigen::Vector3d& centre,
                                         double radius, double voxel_size = 0.5) {
  SceneBody body;
  body.name = std::move(name);
  body.source = BuiltInShape{.kind = BuiltInShape::Kind::kSphere, .radius = radius};
  body.voxel_size = voxel_size;
  body.translation = centre;
  return body;
}

/// The effect that keeps bodies apart.
enum class Keeps : std::uint8_t { kContact, kSprings };

/// Names a test of an effect.
[[nodiscard]] inline std::string name_of(const ::testing::TestParamInfo<Keeps>& keeps) {
  return keeps.param == Keeps::kContact ? "contact" : "springs";
}

inline void keep_apart(Scene& scene, Keeps keeps, const SpringsSettings& springs = {}) {
  scene.contact.reset();
  scene.springs.reset();
  keeps == Keeps::kContact ? void(scene.contact.emplace()) : void(scene.springs = springs);
}

/// A ball of radius 5 mm over a floor, z = 0, between two walls, x = -12 and x = 12, and 30 mm
/// along y a loose ball of radius 4 over the floor. The device rests; there is damping.
[[nodiscard]] inline Scene five_bodies(Keeps keeps) {
  Scene scene{.unit = 1e-3};
  scene.fixed = {box_body("floor", {-30, -30, -8}, {30, 60, 0}),
                 box_body("left", {-20, -30, 1}, {-12, 60, 30}),
                 box_body("right", {12, -30, 1}, {20, 60, 30}),
                 ball_body("loose", {0, 30, 5.5}, 4)};
  scene.fixed.back().attachable = true;
  scene.held = {ball_body("tool", {0, 0, 6}, 5)};
  keep_apart(scene, keeps);
  scene.damping = DampingSettings{};
  scene.device = NullSettings{kDeviceUnderTest};
  return scene;
}

/// The tool's pose at the start, moved by millimetres.
[[nodiscard]] inline Placement moved_by(const Placement& start, const Eigen::Vector3d& by) {
  return {start.rotation, start.translation + 1e-3 * by};
}

}  // namespace ist::test
