#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/mesh/triangle_mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

struct BuildOptions {
  double voxel_size = 0;                       ///< mesh units
  SpherePolicy spheres = SpherePolicy::kSlab;  ///< what to save; the implicit ones cost nothing
  bool keep_triangles = false;                 ///< to answer exactly
  bool proximity = false;                      ///< proximity voxels besides surface voxels
  std::uint64_t max_memory = std::uint64_t{4} << 30;  ///< bytes, for the voxels and the tree
};

struct BuildReport {
  struct Stage {
    const char* name;
    double milliseconds;
  };
  std::vector<Stage> stages;
  std::size_t turned_components = 0;  ///< closed components that were inside out
};

/// From a mesh to a tree: turns it outward, finds its voxels, folds them into an octree and makes
/// the bounds that are saved.
///
/// @param report, progress filled in, if not null
///
/// Cost: on two cores, for a jaw of 107,000 triangles and 1.76 million voxels, 0.5 s; with kTight
/// 1.3 s more, with kSlab 2 s more. Errors: those of voxelize.
[[nodiscard]] IST_API SphereTree build_tree(TriangleMesh mesh, const BuildOptions& options,
                                            BuildReport* report = nullptr,
                                            Progress* progress = nullptr);

/// Whether build_tree() would give a tree: the voxel size is one for this mesh, and what it makes
/// fits the memory that is allowed. Cost: a tenth of the build.
[[nodiscard]] IST_API bool can_build_tree(const TriangleMesh& mesh, const BuildOptions& options,
                                          Progress* progress = nullptr);

}  // namespace ist
