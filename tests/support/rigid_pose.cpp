#include "support/rigid_pose.h"

#include <array>
#include <cmath>

#include "ist/tree/tree_parts.h"
#include "support/exact.h"

namespace ist::test {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;

double in_order(double a, double b, double c) { return (a + b) + c; }

Rows nearer(const Rows& r) {
  Rows rest;  // 3 − RᵀR
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double gram = in_order(r[0][i] * r[0][j], r[1][i] * r[1][j], r[2][i] * r[2][j]);
      rest[i][j] = (i == j ? 3.0 : 0.0) - gram;
    }
  }
  Rows next;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      next[i][j] = in_order(r[i][0] * rest[0][j], r[i][1] * rest[1][j], r[i][2] * rest[2][j]) / 2;
    }
  }
  return next;
}

// Whether an entry of RᵀR - I exceeds 1e-5.
bool is_rough(const Rows& r) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double gram = in_order(r[0][i] * r[0][j], r[1][i] * r[1][j], r[2][i] * r[2][j]);
      if (std::abs(gram - (i == j ? 1.0 : 0.0)) > 1e-5) return true;
    }
  }
  return false;
}

// The root cube's centre in mesh coordinates.
ExactPoint origin_of(const SphereTree& tree) {
  const Lattice& lattice = voxels_of(tree).lattice;
  const mpq_class half = mpq_class(lattice.voxel_size) * (std::uint64_t{1} << lattice.depth) / 2;
  ExactPoint origin;
  for (std::size_t i = 0; i < 3; ++i) origin[i] = lattice.corner[i] + half;
  return origin;
}

}  // namespace

Eigen::Isometry3d rigid_pose(const Eigen::Isometry3d& pose) {
  Rows rows;
  for (std::size_t i = 0; i < 9; ++i) {
    rows[i / 3][i % 3] = pose(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
  }
  if (is_rough(rows)) rows = nearer(rows);
  rows = nearer(nearer(nearer(rows)));
  Eigen::Isometry3d rigid = pose;
  for (std::size_t i = 0; i < 9; ++i) {
    rigid(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = rows[i / 3][i % 3];
  }
  return rigid;
}

Eigen::Isometry3d between_frames(const Eigen::Isometry3d& pose, const SphereTree& fixed,
                                 const SphereTree& moving) {
  Eigen::Isometry3d between = rigid_pose(pose);
  const ExactPoint from = origin_of(moving), to = origin_of(fixed);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const ExactPoint row = exact(between.linear().row(i).transpose());
    const mpq_class translation =
        between.translation()[i] + dot(row, from) - to[static_cast<std::size_t>(i)];
    between.translation()[i] = translation.get_d();
  }
  return between;
}

}  // namespace ist::test
