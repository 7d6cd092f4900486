#include "ist/base/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/base/float_environment.h"

namespace ist {
namespace {

constexpr double kMostError = 1e-3;  // of rotation_error()
constexpr double kMostScale = 1e-5;  // of a scale less 1
// From a rotation that is no farther off, three steps reach the last bit.
constexpr double kThreeSteps = 1e-5;

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

// Returns the largest entry of |gram - I|; infinity where there is none.
double error_of(const Eigen::Matrix3d& gram) noexcept {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double entry = std::abs(gram(i, j) - (i == j ? 1.0 : 0.0));
      if (!(entry <= std::numeric_limits<double>::max())) {
        return std::numeric_limits<double>::infinity();
      }
      largest = std::max(largest, entry);
    }
  }
  return largest;
}

double determinant(const Eigen::Matrix3d& m) noexcept {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
         m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

// Returns whether all eigenvalues of sign · (gram - square I) are above 0, by the leading minors.
bool all_beyond(const Eigen::Matrix3d& gram, double square, double sign) noexcept {
  Eigen::Matrix3d rest = gram;
  for (int i = 0; i < 3; ++i) rest(i, i) -= square;
  rest *= sign;
  return rest(0, 0) > 0 && rest(0, 0) * rest(1, 1) - rest(0, 1) * rest(1, 0) > 0 &&
         determinant(rest) > 0;
}

// Returns whether a matrix lengthens every vector by more than kMostScale, or shortens every one.
bool is_scaled(const Eigen::Matrix3d& gram) noexcept {
  constexpr double kLonger = (1 + kMostScale) * (1 + kMostScale),
                   kShorter = (1 - kMostScale) * (1 - kMostScale);
  return all_beyond(gram, kLonger, 1) || all_beyond(gram, kShorter, -1);
}

// Returns whether a matrix that is farther than kMostError from orthonormal is near to a multiple
// of a rotation.
bool is_far_scaled(const Eigen::Matrix3d& gram) noexcept {
  return error_of(gram / (((gram(0, 0) + gram(1, 1)) + gram(2, 2)) / 3)) <= kMostError;
}

// Returns why a pose is no rigid motion; null if it is one.
const char* fault_of(const Eigen::Matrix4d& m, const Eigen::Matrix3d& gram, double error) noexcept {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m.data()[i])) return "a number is not finite: give finite numbers";
  }
  if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1) {
    return "the last row is not 0 0 0 1: give a rotation and a translation, and look at the order "
           "of the numbers";
  }
  const double volume = determinant(m.block<3, 3>(0, 0));
  if (volume < 0) return "it mirrors: give a rotation, and mirror the mesh instead";
  const bool is_far = !(error <= kMostError);
  if (is_far ? is_far_scaled(gram) : error > kThreeSteps && is_scaled(gram)) {
    return "its scale differs from 1 by more than 1e-5: divide the rotation by its scale, and "
           "scale the mesh instead";
  }
  if (is_far || !(volume > 0)) {
    return "its rotation is farther than 1e-3 from orthonormal: give a rotation";
  }
  return nullptr;
}

// Returns a matrix nearer to the nearest rotation: an error of e becomes one of e² or less.
Eigen::Matrix3d nearer(const Eigen::Matrix3d& rotation) noexcept {
  const Eigen::Matrix3d gram = transpose_times(rotation);
  Eigen::Matrix3d next;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += rotation(i, k) * ((k == j ? 3.0 : 0.0) - gram(k, j));
      next(i, j) = 0.5 * sum;
    }
  }
  return next;
}

}  // namespace

std::optional<Eigen::Isometry3d> project_to_rigid(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  Eigen::Matrix3d rotation = pose.matrix().block<3, 3>(0, 0);
  const Eigen::Matrix3d gram = transpose_times(rotation);
  const double error = error_of(gram);
  if (fault_of(pose.matrix(), gram, error) != nullptr) return std::nullopt;
  // The error falls as 1e-3, 1e-5, 1e-10, 1e-20: the last step settles the last bit.
  if (error > kThreeSteps) rotation = nearer(rotation);
  for (int step = 0; step < 3; ++step) rotation = nearer(rotation);
  Eigen::Isometry3d rigid = pose;
  rigid.matrix().block<3, 3>(0, 0) = rotation;
  return rigid;
}

double rotation_error(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  return error_of(transpose_times(pose.matrix().block<3, 3>(0, 0)));
}

const char* why_not_rigid(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  const Eigen::Matrix3d gram = transpose_times(pose.matrix().block<3, 3>(0, 0));
  const char* fault = fault_of(pose.matrix(), gram, error_of(gram));
  return fault != nullptr ? fault : "";
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
