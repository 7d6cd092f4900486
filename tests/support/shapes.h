#pragma once

#include <Eigen/Core>

#include "ist/mesh/triangle_mesh.h"

namespace ist::test {

/// A closed box of 12 triangles, normals outward.
[[nodiscard]] TriangleMesh box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// One triangle.
[[nodiscard]] TriangleMesh triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

/// An icosahedron whose triangles are cut in four `level` times, its vertices on the sphere round
/// the origin: 20 * 4^level triangles, normals outward. Made with + - * / and square roots only,
/// so that it is the same bits everywhere.
[[nodiscard]] TriangleMesh icosphere(int level, double radius);

/// A flat strip of `squares` unit squares along x, of two triangles each, normals along +z.
[[nodiscard]] TriangleMesh open_strip(int squares);

/// Both meshes as one, the second one's vertices after the first one's.
[[nodiscard]] TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

/// The mesh with every triangle turned over.
[[nodiscard]] TriangleMesh inside_out(TriangleMesh mesh);

/// The mesh moved.
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by);

}  // namespace ist::test
