#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/scene.h"

namespace ist {

/// A body of a scene as read from its file or made from its shape.
struct LoadedBody {
  const char* table;  ///< of the scene: "fixed" or "held"
  std::string name;   ///< of the file or the shape, for messages
  /// Oriented outward. Null if the source is a tree that was built without triangles.
  std::unique_ptr<TriangleMesh> mesh;
  std::unique_ptr<const SphereTree> tree;            ///< null unless the source is a tree
  bool outside_is_known = false;                     ///< from its triangles, or trusted
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< centre of the grid, mesh coordinates
};

/// Reads or makes the body of the table "fixed" or "held", and adds the flaws of its mesh to
/// `warnings`. Throws the errors of reading; kInputInvalid (fail_at) for a missing voxel size or
/// one that does not fit the mesh.
[[nodiscard]] LoadedBody load_body(const Scene& scene, const SceneBody& body, const char* table,
                                   std::vector<std::string>& warnings);

}  // namespace ist
