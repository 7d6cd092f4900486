#include "ist/base/symmetric_eigen.h"

#include <cmath>
#include <utility>

namespace ist {
namespace {

// Sweeps converge quadratically: three or four suffice for any matrix.
constexpr int kMaxSweeps = 16;

// Applies a Jacobi rotation in the plane of axes p and q that makes element (p, q) of the matrix
// zero. Returns false if the element is zero to within a rounding of the diagonal.
bool rotate(Eigen::Matrix3d& a, Eigen::Matrix3d& vectors, int p, int q) noexcept {
  const double off = a(p, q);
  if (std::abs(off) <= 0x1p-54 * (std::abs(a(p, p)) + std::abs(a(q, q)))) return false;
  const double theta = (a(q, q) - a(p, p)) / (2 * off);
  const double size = 1 / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double t = theta < 0 ? -size : size;  // tangent of the smaller angle
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  a(p, p) -= t * off;
  a(q, q) += t * off;
  a(p, q) = 0;
  const int r = 3 - p - q;
  double& to_p = a(p < r ? p : r, p < r ? r : p);
  double& to_q = a(q < r ? q : r, q < r ? r : q);
  const double before_p = to_p, before_q = to_q;
  to_p = c * before_p - s * before_q;
  to_q = s * before_p + c * before_q;
  for (int i = 0; i < 3; ++i) {
    const double in_p = vectors(i, p), in_q = vectors(i, q);
    vectors(i, p) = c * in_p - s * in_q;
    vectors(i, q) = s * in_p + c * in_q;
  }
  return true;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) noexcept {
  Eigen::Matrix3d a = matrix;
  SymmetricEigen result{{}, Eigen::Matrix3d::Identity()};
  bool turned = true;
  for (int sweep = 0; sweep < kMaxSweeps && turned; ++sweep) {
    turned = rotate(a, result.vectors, 0, 1);
    turned |= rotate(a, result.vectors, 0, 2);
    turned |= rotate(a, result.vectors, 1, 2);
  }
  result.values = a.diagonal();
  const auto order = [&result](int i, int j) {
    if (result.values[i] <= result.values[j]) return;
    std::swap(result.values[i], result.values[j]);
    result.vectors.col(i).swap(result.vectors.col(j));
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return result;
}

}  // namespace ist
