#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "ist/haptics/coupling.h"
#include "ist/haptics/devices/hand_device.h"
#include "ist/haptics/effects/contact_effect.h"
#include "ist/haptics/effects/damping_effect.h"
#include "ist/haptics/effects/friction_effect.h"
#include "ist/haptics/effects/proximity_effect.h"
#include "ist/haptics/effects/snap_effect.h"
#include "ist/haptics/safety.h"
#include "ist/scene/scene_lines.h"
#include "ist/tree/sphere_policy.h"

namespace ist {

/// A shape that needs no file. The centre of a box, a sphere or a cylinder is at 0, a cylinder's
/// axis is z; jaws stand as make_jaw() makes them.
struct BuiltInShape {
  enum class Kind { kUpperJaw, kLowerJaw, kBox, kSphere, kCylinder };
  Kind kind;
  std::uint64_t seed = 1;                          ///< of a jaw
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< of a box, mesh units
  double radius = 1, height = 1;                   ///< of a sphere or a cylinder, mesh units
};

/// One of the two bodies, as a scene names it. Lengths are in the scene's unit.
struct SceneBody {
  std::variant<std::filesystem::path, BuiltInShape> source;  ///< a mesh or a tree file, or a shape
  std::optional<double> voxel_size;                          ///< nothing where the source is a tree
  std::optional<SpherePolicy> spheres;  ///< nothing: the tightest that both have
  bool trust_normals = false;  ///< contact forces though the mesh is not closed and consistent
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from mesh to scene
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// What a scene's table `gravity` says: GravitySettings, but for the place of the centre of mass,
/// which is in the tool's frame there, and that is known when the held body is built.
struct SceneGravity {
  double mass;                            ///< of the held body, kg
  std::optional<Eigen::Vector3d> centre;  ///< of mass, mesh units and axes; nothing: tool's origin
  Eigen::Vector3d acceleration;           ///< m/s², axes of the scene
};

struct NullSettings {
  DeviceMechanics mechanics;
};
struct ScriptSettings {
  DeviceMechanics mechanics;
  std::filesystem::path file;
  std::vector<Waypoint> plan;
};

/// What a scene file says, checked for itself: nothing of it is built. SI but for the bodies. Where
/// a pose of the tool is named, it is given as a motion of the held body from where the scene puts
/// it: first a turn about the centre of its grid, then a translation, scene axes.
struct Scene {
  std::filesystem::path file;
  SceneLines lines;     ///< of `file`
  double unit;          ///< metres in the unit of lengths
  double rate = 1000;   ///< ticks a second
  double seconds = 10;  ///< how long it runs
  int workers = 1;      ///< threads that look for contacts, 1 or 2
  SceneBody fixed, held;
  /// The axis, of unit length, along which the held body is moved until it is free.
  std::optional<Eigen::Vector3d> open;
  std::variant<NullSettings, ScriptSettings, HandSettings> device;
  CouplingSettings coupling;
  SafetySettings safety;

  std::optional<ContactSettings> contact;
  std::optional<FrictionSettings> friction;
  std::optional<DampingSettings> damping;
  std::optional<ProximitySettings> proximity;
  std::optional<SceneGravity> gravity;
  std::optional<SnapSettings> snap;
};

}  // namespace ist
