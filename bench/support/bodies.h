#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <utility>

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "support/rigid_pose.h"

namespace ist::bench {

/// A file of IST_DATA_DIR, by default ../shared/data beside the project's root; whether it is there
/// or not.
[[nodiscard]] std::filesystem::path data_file(const char* name);

/// A file of tests/data/scenes.
[[nodiscard]] std::filesystem::path scene_file(const char* name);

/// The upper and the lower jaw that is measured: the real pair of data_file(), or the built-in one
/// where that is not there. Read once.
[[nodiscard]] const TriangleMesh& upper_jaw();
[[nodiscard]] const TriangleMesh& lower_jaw();
/// "human" or "built-in".
[[nodiscard]] const char* pair_name();

[[nodiscard]] SphereTree build(const TriangleMesh& mesh, double voxel_size, SpherePolicy spheres);

/// Both trees of a voxel size, which answer every policy; made once.
[[nodiscard]] const std::pair<SphereTree, SphereTree>& trees(double voxel_size);
/// The trees of trees(), with their triangles.
[[nodiscard]] const std::pair<SphereTree, SphereTree>& triangle_trees(double voxel_size);

using test::closing;

/// Displacements that are measured: full occlusion, …, just before contact.
inline constexpr double kClosing[] = {0, -0.5, -1, -1.5, -2};

}  // namespace ist::bench
