#pragma once

#include <Eigen/Geometry>
#include <string>

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist::answers {

/// Returns the box round the triangles of a mesh, mesh units. Cost: 5 ns a triangle.
[[nodiscard]] Eigen::AlignedBox3d box_of(const TriangleMesh& mesh);

/// Returns the box round the triangles of a tree, or round its surface voxels if it keeps none.
/// Cost: 5 ns a triangle, or 20 ns a voxel.
[[nodiscard]] Eigen::AlignedBox3d box_of(const SphereTree& tree);

/// Returns the largest side of a box.
[[nodiscard]] double largest_extent(const Eigen::AlignedBox3d& box);

/// The number of voxels along the largest extent of a body by default.
inline constexpr double kVoxelsOfExtent = 500;

/// Returns the default voxel size: 1/500 of `extent`, to three significant digits.
[[nodiscard]] double rounded_voxel_size(double extent);

/// Returns a number for people, to four significant digits or to whole ones.
[[nodiscard]] std::string number_text(double number);

/// Returns the sides of a box for people, "68.2 x 116.4 x 55.0": the largest to `digits`
/// significant digits, the others to as many decimals.
[[nodiscard]] std::string sides_text(const Eigen::Vector3d& sides, int digits = 4);

/// Returns the box for people, "[-34.1, 34.1] [0.0, 116.4] [0.0, 55.0]", to the decimals of its
/// sides.
[[nodiscard]] std::string box_text(const Eigen::AlignedBox3d& box);

/// Returns the size that the sides have if their unit is `unit`, "6.8 x 11.6 x 5.5 cm": in metres,
/// centimetres, millimetres or micrometres, to three significant digits. Precondition: the unit is
/// not kUnknown.
[[nodiscard]] std::string size_text(const Eigen::Vector3d& sides, LengthUnit unit);

}  // namespace ist::answers
