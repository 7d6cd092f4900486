#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// A closed box of 12 triangles, normals outward.
[[nodiscard]] TriangleMesh box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// One triangle.
[[nodiscard]] TriangleMesh triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

/// One triangle, `triangles` times: its corners are about 1 from the origin.
[[nodiscard]] TriangleMesh coincident(std::size_t triangles);

/// An icosahedron whose triangles are cut in four `level` times, its vertices on the sphere round
/// the origin: 20 * 4^level triangles, normals outward. Made with + - * / and square roots only,
/// so that it is the same bits everywhere.
[[nodiscard]] TriangleMesh icosphere(int level, double radius);

/// A closed cylinder round the z axis, from z = 0 up, of 4 * `quarter` sides, its corners on the
/// circle; normals outward. Like the sphere the same bits everywhere.
[[nodiscard]] TriangleMesh cylinder(int quarter, double radius, double height);

/// The cylinder with a hole along its axis: a thick pipe.
[[nodiscard]] TriangleMesh pipe(int quarter, double inner, double outer, double height);
/// A solid of revolution about z, in `around` parts, its vertices on the surface. The outline is
/// of (radius, z), closed and counterclockwise; points at radius 0 become one vertex each.
[[nodiscard]] TriangleMesh revolved(const std::vector<Eigen::Vector2d>& outline, int around);

/// A torus about z, normals outward, its vertices on the surface: `around` times `across` squares
/// of two triangles.
[[nodiscard]] TriangleMesh torus(double ring, double tube, int around, int across);

/// The tube between two cylinders about z of radius `inner` and `outer`, |z| <= `half`; with
/// `inner` 0 a cylinder. Its squares are about `edge` wide.
[[nodiscard]] TriangleMesh tube(double inner, double outer, double half, double edge);

/// A closed plate of unit cubes, one thick, with `holes` square holes through it: of that genus.
/// Its corner is the origin, its faces are in planes of whole numbers, normals outward.
[[nodiscard]] TriangleMesh plate_with_holes(int holes);

/// A flat strip of `squares` unit squares along x, of two triangles each, normals along +z.
[[nodiscard]] TriangleMesh open_strip(int squares);

/// Both meshes as one, the second one's vertices after the first one's.
[[nodiscard]] TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

/// The mesh with every triangle turned over.
[[nodiscard]] TriangleMesh inside_out(TriangleMesh mesh);

/// The mesh turned about the origin.
[[nodiscard]] TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3d& by);

/// The mesh moved.
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by);

/// Returns how often a mesh goes round a point: the sum of its triangles' solid angles. It is no
/// whole number for an open mesh. Rounding matters near the surface only.
/// Source: A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Transactions on
/// Biomedical Engineering 30(2), 1983.
[[nodiscard]] inline double winding_by_angles(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p,
                          c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

/// FNV-1a over all bytes of a mesh.
[[nodiscard]] inline std::uint64_t fingerprint(const TriangleMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](const void* data, std::size_t size) {
    std::vector<unsigned char> bytes(size);
    std::memcpy(bytes.data(), data, size);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  };
  add(mesh.vertices.data(), mesh.vertices.size() * sizeof(mesh.vertices[0]));
  add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return hash;
}

}  // namespace ist::test
