#include "verify/leaf_geometry.h"

#include <Eigen/Geometry>

namespace ist {
namespace {

using Eigen::Vector3d;

// Edges of two cubes closer to parallel than this, a sine, count as parallel. The omitted axis
// could separate only cubes closer than this fraction of an edge, which is less than the shrinking;
// the other axes are long enough for rounding in double to be less, too.
constexpr double kParallel = 1e-7;

// Returns the sign of a tetrahedron's volume, or 0 if it is uncertain: the volume is a product of
// three edges, each uncertain by twice the tolerance. If all are longer than eight tolerances, the
// volume's error is less than three tolerances times the sum; if one is not, the volume itself is
// below eight.
int sure_side(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
              double tolerance) noexcept {
  const Vector3d u = b - a, v = c - a, w = d - a;
  const double volume = u.dot(v.cross(w));
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double doubt = 8 * tolerance * (lu * lv + lv * lw + lw * lu);
  return std::abs(volume) > doubt ? (volume > 0 ? 1 : -1) : 0;
}

bool pierces(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
             const Vector3d& c, double tolerance) noexcept {
  const int above = sure_side(a, b, c, p, tolerance);
  if (above == 0 || sure_side(a, b, c, q, tolerance) != -above) return false;
  const int turn = sure_side(p, q, a, b, tolerance);
  return turn != 0 && sure_side(p, q, b, c, tolerance) == turn &&
         sure_side(p, q, c, a, tolerance) == turn;
}

// Returns whether an edge of one polygon, or a line from its middle to a corner, passes through the
// other: where a body meets its mirror image, edges only meet edges.
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

CubeAxes::CubeAxes(double first_edge, double second_edge, const Eigen::Matrix3d& rotation,
                   double tolerance) {
  const double first_half = (0.5 - kShrink) * first_edge,
               second_half = (0.5 - kShrink) * second_edge;
  const auto add = [&](const Vector3d& direction) {
    if (direction.squaredNorm() < kParallel * kParallel) return;
    axes_.push_back({direction, first_half * direction.lpNorm<1>() +
                                    second_half * (rotation.transpose() * direction).lpNorm<1>() -
                                    tolerance * direction.norm()});
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(Vector3d::Unit(i));
    add(rotation.col(i));
    for (Eigen::Index j = 0; j < 3; ++j) add(Vector3d::Unit(i).cross(rotation.col(j)));
  }
}

bool CubeAxes::surely_meet(const Vector3d& apart) const noexcept {
  return std::all_of(axes_.begin(), axes_.end(), [&](const Axis& axis) {
    return std::abs(axis.direction.dot(apart)) <= axis.extent;
  });
}

std::vector<ClippedTriangle> leaf_polygons(const SphereTree& tree, std::uint32_t leaf,
                                           std::uint64_t code) {
  const TriangleMesh& mesh = parts_of(tree).triangles->mesh;
  const Lattice& lattice = voxels_of(tree).lattice;
  const Cell cell = morton_decode(code);
  const Vector3d low(cell[0], cell[1], cell[2]);
  const Vector3d root = Vector3d::Constant(lattice.root_centre());
  std::vector<ClippedTriangle> polygons;
  for (const std::uint32_t id : voxels_of(tree).lists[leaf]) {
    std::array<Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = lattice.to_lattice(mesh.vertices[mesh.triangles[id][i]]);
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
