#pragma once

/// @file
/// Scenes: bodies, a device and the effects between them, read from TOML or made by a program.
/// Link libist_loop (CMake ist::loop).
#include "ist/base/api.h"

#if __cplusplus >= 202002L  // else ist/base/api.h has said what is needed
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/progress.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
class SceneLines;
}

/// A shape that needs no file. Boxes, spheres and cylinders have their centre at 0, cylinders their
/// axis along z; jaws are placed as by make_jaw().
struct BuiltInShape {
  /// The kind of a shape.
  enum class Kind {
    kUpperJaw,  ///< make_jaw(Jaw::kUpper, seed)
    kLowerJaw,  ///< make_jaw(Jaw::kLower, seed)
    kBox,       ///< as wide along x, y and z as `size`
    kSphere,    ///< of `radius`
    kCylinder,  ///< of `radius` and `height`
    kSplint,    ///< make_splint(seed, opening)
    kFossa,     ///< of inner `radius` and `thickness`, opening towards -z
  };
  Kind kind = Kind::kBox;                          ///< decides which members count
  std::uint64_t seed = 1;                          ///< of a jaw, or of the jaws of a splint
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< of a box, mesh units
  double radius = 1,  ///< of a sphere, a cylinder or the inside of a fossa, mesh units
      height = 1,     ///< of a cylinder, mesh units
      opening = 5,    ///< by which a splint's lower jaw is lowered, mm
      thickness = 1;  ///< of a fossa, mesh units
};

/// Makes the mesh of a shape: closed, facing outward, in the scene's unit, with the same bits on
/// every machine. Spheres (20,480 triangles) and cylinders (1,024) lie within their surface, no
/// farther from it than 3e-4 of their radius; a fossa's triangles (16,384) lie no farther below the
/// spheres of their vertices than 1e-3 of the radius. Throws kArgumentInvalid for a length outside
/// 1e-12 to 1e12, and for an opening that make_splint() refuses.
[[nodiscard]] IST_API TriangleMesh make_shape(const BuiltInShape& shape);

/// A body of a scene. Lengths are in the scene's unit.
struct SceneBody {
  /// For changes, recordings and messages; no two bodies share one. By default "fixed" or "held",
  /// of several the first is "fixed.1".
  std::string name = {};
  /// A mesh file, a tree file or a shape.
  std::variant<std::filesystem::path, BuiltInShape> source = {};
  /// For `springs` and for effects of a program in a scene without `contact`: required then unless
  /// the source is a tree. No other effect builds these voxels.
  std::optional<double> voxel_size = {};
  std::optional<SpherePolicy> spheres = {};  ///< by default the tightest that both bodies have
  bool trust_normals = false;  ///< contact forces even if the mesh is not closed and consistent
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from mesh to scene
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< of the mesh's origin, scene axes
  bool attachable = false;                                 ///< the hand may take it and release it
  /// Of a fixed body: its motions from that place, as those of the tool, but about the middle of
  /// its own box; empty: it rests. It rests after the last waypoint, and is not attachable. With
  /// `springs` it moves by half a voxel a tick at most. With `contact` it pushes the tool, and
  /// waits if the tool cannot yield.
  std::vector<Waypoint> script = {};
  std::filesystem::path script_file = {};  ///< from which `script` was read; empty otherwise
};

/// A body that the hand takes or releases during a run.
struct SceneChange {
  double time = 0;     ///< from the first tick on, s
  std::string body;    ///< its name
  bool attach = true;  ///< false: it is released
};

/// GravitySettings, with the centre of mass in mesh coordinates: the tool's frame is known only
/// when the held body is built.
struct SceneGravity {
  double mass = 0;  ///< of the held body, kg
  /// The centre of mass, mesh units; by default the tool's origin.
  std::optional<Eigen::Vector3d> centre = {};
  Eigen::Vector3d acceleration = {0, 0, -9.81};  ///< m/s², scene axes
};

/// A device that rests at the start.
struct NullSettings {
  DeviceMechanics mechanics = {};  ///< by which the coupling is kept stable
};
/// A device that follows a plan whatever the wrench.
struct ScriptSettings {
  DeviceMechanics mechanics = {};   ///< by which the coupling is kept stable
  std::filesystem::path file = {};  ///< from which `plan` was read; empty otherwise
  std::vector<Waypoint> plan = {};  ///< at least one waypoint
};

/// The content of a scene file, or a scene made by a program. SI but for the bodies and `contact`.
/// Poses of the tool are motions of the held bodies from their places in the scene: a turn about
/// the origin of the tool, then a translation along scene axes.
struct Scene {
  std::filesystem::path file = {};                       ///< for messages
  std::string text = {};                                 ///< of `file`; empty without a file
  std::shared_ptr<const detail::SceneLines> lines = {};  ///< of keys in `file`; null without a file
  double unit = 0;      ///< metres in the unit of lengths; required
  double rate = 1000;   ///< ticks a second, 1 to 10,000
  double seconds = 10;  ///< length of a run
  int workers = 1;      ///< threads that search for contacts, 1 or 2
  /// One at least.
  std::vector<SceneBody> fixed = std::vector<SceneBody>(1);
  /// In the hand, and moved as one: one at least. The first one gives the tool its frame.
  std::vector<SceneBody> held = std::vector<SceneBody>(1);
  std::vector<SceneChange> changes = {};  ///< by ascending time
  /// The axis, of unit length, along which the held body is moved until it is free.
  std::optional<Eigen::Vector3d> open = {};
  /// The tool's origin in mesh coordinates of the first held body. By default the middle of the
  /// box round that mesh.
  std::optional<Eigen::Vector3d> origin = {};
  std::variant<NullSettings, ScriptSettings, HandSettings> device = {};  ///< by default it rests
  CouplingSettings coupling = {};  ///< between device and tool
  SafetySettings safety = {};      ///< limits of the wrench on the hand

  std::optional<ContactSettings> contact = {};      ///< absent: nothing keeps the bodies apart
  std::optional<SpringsSettings> springs = {};      ///< in place of `contact`, not beside it
  std::optional<FrictionSettings> friction = {};    ///< needs `contact`
  std::optional<DampingSettings> damping = {};      ///< needs `contact` or `springs`
  std::optional<ProximitySettings> proximity = {};  ///< absent: the tool is not slowed
  std::optional<SceneGravity> gravity = {};         ///< absent: the held body weighs nothing
  std::optional<SnapSettings> snap = {};            ///< its pose is a motion
};

/// Reads a scene file (TOML; docs/scene-reference.md lists the keys). Relative paths start at the
/// file's folder. Throws kInputInvalid, naming file, line and remedy, for a file that is no TOML,
/// an unknown or missing key, a value of the wrong kind or out of range, and a missing file.
[[nodiscard]] IST_API Scene read_scene(const std::filesystem::path& file);

/// The trees of a body of a scene, as far as its effects need them.
struct BodyTrees {
  std::unique_ptr<const SphereTree> contact = {},  ///< for contacts
      near = {},    ///< with proximity voxels, of a body that may be fixed
      coarse = {};  ///< in voxels of that size, of a body that may be held
};

/// A stage of build_scene(), built or skipped.
struct BuildNote {
  std::string what;         ///< the stage, for people
  bool built = false;       ///< false: skipped
  std::string why;          ///< the effects that need it, or the reason to skip it
  double milliseconds = 0;  ///< wall time; 0 if skipped
  std::uint64_t bytes = 0;  ///< memory of the result; 0 if skipped
};

/// A scene ready to run, with the trees and queries that its effects need.
struct BuiltScene {
  std::vector<BodyTrees> trees = {};            ///< by body: the fixed ones, then the held ones
  std::unique_ptr<Simulation> simulation = {};  ///< refers to the trees
  std::unique_ptr<Device> device = {};          ///< as Scene::device says
  /// The tool's origin in mesh coordinates of the first held body.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double step_limit = 0;  ///< bound on the displacement of the tool's surface in a tick, m
  std::vector<BuildNote> notes = {};       ///< in the order of building
  std::vector<std::string> warnings = {};  ///< sentences for people
};

/// Reads or makes the bodies, builds what the effects need, and places the tool. The tool starts at
/// the beginning of the device's plan; if the bodies intersect there, or one is inside the other,
/// it is moved along Scene::open until they are free. If no effect needs contacts, nothing is
/// searched. Of several bodies, a pair that cannot meet wherever the device's plan leads has no
/// query: should its roots overlap all the same, the tool is held.
///
/// The coupling is clamped to the stability border of the device in Scene::device. To run another
/// device, put its mechanics there: `scene.device = NullSettings{mechanics}`.
///
/// Effects of the caller's `own` are called after the scene's, and their needs() join the needs of
/// the scene's. If the outside of a body is not known, effects that need normals, depth or
/// proximity are left out, with a warning. `max_memory` is in bytes, for each tree, and for all
/// queries together.
///
/// Throws the errors of reading a mesh or a tree; kArgumentInvalid for a null effect or a shape
/// without extent; kInputInvalid, with the scene's file, line and remedy, for missing trees or
/// meshes, voxels that are too small, a start that is not free, queries beyond the memory, and, in
/// a scene made by a program, a value out of range.
[[nodiscard]] IST_API BuiltScene build_scene(const Scene& scene,
                                             std::vector<std::unique_ptr<Effect>> own = {},
                                             std::uint64_t max_memory = BuildOptions{}.max_memory,
                                             Progress* progress = nullptr);

}  // namespace ist
#endif
