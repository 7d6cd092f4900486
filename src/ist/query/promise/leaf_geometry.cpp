#include "ist/query/promise/leaf_geometry.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "ist/voxel/morton.h"

namespace ist {
namespace {

using Eigen::Vector3d;

// Edges of two cubes closer to parallel than this count as parallel. The axis that is then left out
// could tell apart only what is nearer than this part of an edge, which is less than the shrinking;
// and the others are long enough for the rounding of a double to be less than it, too.
constexpr double kParallel = 1e-7;

// Six times the volume of a tetrahedron, or 0 where its sign is not certain: it is a product of
// three edges, each of which is wrong by twice the tolerance. Where all are over eight tolerances
// long, the volume is wrong by less than three tolerances times the sum; where one is not, the
// volume is itself below eight.
double sure_volume(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
                   double tolerance) noexcept {
  const Vector3d u = b - a, v = c - a, w = d - a;
  const double volume = u.dot(v.cross(w));
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double doubt = 8 * tolerance * (lu * lv + lv * lw + lw * lu);
  return std::abs(volume) > doubt ? volume : 0;
}

bool pierces(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
             const Vector3d& c, double tolerance) noexcept {
  const double above = sure_volume(a, b, c, p, tolerance);
  if (above == 0) return false;
  const double below = sure_volume(a, b, c, q, tolerance);
  if (below == 0 || (above > 0) == (below > 0)) return false;
  const double first = sure_volume(p, q, a, b, tolerance);
  if (first == 0) return false;
  const double second = sure_volume(p, q, b, c, tolerance);
  if (second == 0 || (first > 0) != (second > 0)) return false;
  const double third = sure_volume(p, q, c, a, tolerance);
  return third != 0 && (first > 0) == (third > 0);
}

// Whether an edge of one passes through the other, or a line from the middle of the one to its
// corner: where a body meets its mirror image, edges only meet edges.
bool line_pierces(const ClippedTriangle& lines, const ClippedTriangle& face,
                  double tolerance) noexcept {
  const auto corner = [](const ClippedTriangle& polygon, int i) -> const Vector3d& {
    return polygon.corners[static_cast<std::size_t>(i)];
  };
  const auto pierces_face = [&](const Vector3d& p, const Vector3d& q) {
    for (int j = 2; j < face.count; ++j) {
      if (pierces(p, q, corner(face, 0), corner(face, j - 1), corner(face, j), tolerance)) {
        return true;
      }
    }
    return false;
  };
  Vector3d middle = Vector3d::Zero();
  for (int i = 0; i < lines.count; ++i) middle += corner(lines, i) / lines.count;
  for (int i = 0, last = lines.count - 1; i < lines.count; last = i++) {
    if (pierces_face(corner(lines, last), corner(lines, i)) ||
        pierces_face(middle, corner(lines, i))) {
      return true;
    }
  }
  return false;
}

}  // namespace

CubeAxes::CubeAxes(double first_edge, double second_edge, const Eigen::Matrix3d& rotation) {
  const double first_half = (0.5 - kShrink) * first_edge,
               second_half = (0.5 - kShrink) * second_edge;
  const auto add = [&](const Vector3d& direction) {
    if (direction.squaredNorm() < kParallel * kParallel) return;
    axes_.push_back({direction, first_half * direction.lpNorm<1>() +
                                    second_half * (rotation.transpose() * direction).lpNorm<1>()});
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(Vector3d::Unit(i));
    add(rotation.col(i));
    for (Eigen::Index j = 0; j < 3; ++j) add(Vector3d::Unit(i).cross(rotation.col(j)));
  }
}

bool CubeAxes::surely_meet(const Vector3d& apart) const noexcept {
  for (const Axis& axis : axes_) {
    if (!(std::abs(axis.direction.dot(apart)) <= axis.reach)) return false;
  }
  return true;
}

std::vector<ClippedTriangle> leaf_polygons(const SphereTree& tree, std::uint32_t leaf,
                                           std::uint64_t code) {
  const LeafTriangles& triangles = *tree.triangles();
  const Lattice& lattice = tree.lattice();
  const Cell cell = morton_decode(code);
  const Vector3d low(cell[0], cell[1], cell[2]);
  const Vector3d root = Vector3d::Constant(lattice.root_centre());
  std::vector<ClippedTriangle> polygons;
  for (const std::uint32_t id : triangles.lists[leaf]) {
    std::array<Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = lattice.to_lattice(triangles.mesh.vertices[triangles.mesh.triangles[id][i]]);
    }
    ClippedTriangle polygon;
    clip_triangle(corners, low, low + Vector3d::Ones(), polygon);
    for (int i = 0; i < polygon.count; ++i) {
      Vector3d& p = polygon.corners[static_cast<std::size_t>(i)];
      p = lattice.voxel_size * (p - root);
    }
    if (polygon.count > 0) polygons.push_back(polygon);
  }
  return polygons;
}

bool surely_cross(const ClippedTriangle& a, const ClippedTriangle& b, double tolerance) noexcept {
  return line_pierces(a, b, tolerance) || line_pierces(b, a, tolerance);
}

}  // namespace ist
