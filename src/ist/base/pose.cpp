#include "ist/base/pose.h"

#include <cmath>

#include "ist/base/float_environment.h"

namespace ist {
namespace {

constexpr double kTolerance = 1e-5;  // bound of each entry of RᵀR - I

// Returns AᵀA, written out so that no library decides the order of the sums.
Eigen::Matrix3d transpose_times(const Eigen::Matrix3d& a) noexcept {
  Eigen::Matrix3d product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      product(i, j) = (a(0, i) * a(0, j) + a(1, i) * a(1, j)) + a(2, i) * a(2, j);
    }
  }
  return product;
}

bool is_nearly_orthonormal(const Eigen::Matrix3d& gram) noexcept {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!(std::abs(gram(i, j) - (i == j ? 1.0 : 0.0)) <= kTolerance)) return false;
    }
  }
  return true;
}

double determinant(const Eigen::Matrix3d& m) noexcept {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
         m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

}  // namespace

std::optional<Eigen::Isometry3d> project_to_rigid(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  const Eigen::Matrix4d& m = pose.matrix();
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m.data()[i])) return std::nullopt;
  }
  if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1) return std::nullopt;
  Eigen::Matrix3d rotation = m.block<3, 3>(0, 0);
  if (!is_nearly_orthonormal(transpose_times(rotation))) return std::nullopt;
  if (!(determinant(rotation) > 0)) return std::nullopt;
  // The error falls as 1e-5, 1e-10, 1e-20: two steps reach the last bit, a third settles it.
  for (int step = 0; step < 3; ++step) {
    const Eigen::Matrix3d gram = transpose_times(rotation);
    Eigen::Matrix3d next;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += rotation(i, k) * ((k == j ? 3.0 : 0.0) - gram(k, j));
        next(i, j) = 0.5 * sum;
      }
    }
    rotation = next;
  }
  Eigen::Isometry3d rigid = pose;
  rigid.matrix().block<3, 3>(0, 0) = rotation;
  return rigid;
}

std::optional<Eigen::Isometry3d> compose_rigid(const Eigen::Isometry3d& second,
                                               const Eigen::Isometry3d& first) noexcept {
  const ScopedFloatEnvironment environment;
  const Eigen::Matrix4d &a = second.matrix(), &b = first.matrix();
  Eigen::Isometry3d product;
  for (int i = 0; i < 4; ++i) {  // all four rows, so that a wrong last row is refused
    for (int j = 0; j < 4; ++j) {
      product.matrix()(i, j) =
          ((a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + a(i, 2) * b(2, j)) + a(i, 3) * b(3, j);
    }
  }
  return project_to_rigid(product);
}

}  // namespace ist
