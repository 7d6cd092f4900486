#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/scene.h"

namespace ist {

/// A body of a scene as read from its file or made from its shape.
struct LoadedBody {
  const SceneBody* named;  ///< as the scene has it
  bool held;               ///< in the hand at the start
  std::string table;       ///< its path in the scene: "fixed", "fixed.2" or "held"
  std::string name;        ///< of the file or the shape, for messages
  /// Oriented outward. Null if the source is a tree that was built without triangles.
  std::unique_ptr<TriangleMesh> mesh;
  std::unique_ptr<const SphereTree> tree;       ///< null unless the source is a tree
  bool outside_is_known = false;                ///< from its triangles, or trusted
  PatientFrame frame = PatientFrame::kUnknown;  ///< as its file says it
  /// The origin of the body's frame, mesh coordinates: the middle of its box, or Scene::origin.
  /// Without a mesh the centre of the grid.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double radius = 0;      ///< bounds the distance of the surface from there, mesh units
  double diagonal = 0;    ///< of its box, mesh units; without a mesh of the box round its voxels
  double voxel_size = 0;  ///< mesh units; 0 without voxels

  /// Whether it is fixed at some time of a run.
  [[nodiscard]] bool may_be_fixed() const { return !held || named->attachable; }
  /// Whether it is in the hand at some time of a run.
  [[nodiscard]] bool may_be_held() const { return held || named->attachable; }
};

/// Reads or makes all bodies: the fixed ones, then the held ones. `voxels` says whether the scene
/// needs their voxels. Adds the flaws of their meshes to `warnings`. Throws the errors of reading;
/// kInputInvalid (fail_at) for a voxel size that does not fit the mesh, and for files that name
/// different frames of a patient.
[[nodiscard]] std::vector<LoadedBody> load_bodies(const Scene& scene, bool voxels,
                                                  std::vector<std::string>& warnings);

}  // namespace ist
