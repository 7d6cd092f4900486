#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ist/mesh/triangle_mesh.h"
#include "ist/scene/scene.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// A body of a scene as its file or shape gives it, before anything is built.
struct LoadedBody {
  const char* table;  ///< of the scene: "fixed" or "held"
  std::string name;   ///< of the file or the shape, for people
  /// Turned outward. Null where the source is a tree that was built without triangles.
  std::unique_ptr<TriangleMesh> mesh;
  std::unique_ptr<const SphereTree> tree;            ///< null where the source is none
  bool outside_is_known = false;                     ///< by its triangles, or it is trusted
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< centre of the grid, mesh coordinates
};

/// Reads or makes a body of the scene, that of the table "fixed" or "held"; what is wrong with it
/// is added to `warnings`. Throws what reading throws, and kInputInvalid, by the scene's file and
/// line, for a voxel size that does not fit the mesh.
[[nodiscard]] LoadedBody load_body(const Scene& scene, const SceneBody& body, const char* table,
                                   std::vector<std::string>& warnings);

}  // namespace ist
