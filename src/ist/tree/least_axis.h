#pragma once

#include <Eigen/Core>
#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {

/// A symmetric matrix of three rows.
struct Symmetric {
  double xx, xy, xz, yy, yz, zz;

  [[nodiscard]] double trace() const noexcept { return (xx + yy) + zz; }
  /// Returns the square, divided by the square of the trace.
  [[nodiscard]] Symmetric squared() const noexcept {
    const double s = 1 / trace();
    const double a = s * xx, b = s * xy, c = s * xz, d = s * yy, e = s * yz, f = s * zz;
    return {(a * a + b * b) + c * c, (a * b + b * d) + c * e, (a * c + b * e) + c * f,
            (b * b + d * d) + e * e, (b * c + d * e) + e * f, (c * c + e * e) + f * f};
  }
  /// Returns the adjugate: the inverse times the determinant.
  [[nodiscard]] Symmetric adjugate() const noexcept {
    return {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
            xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
  }
  /// Returns the unit vector along the column whose diagonal element is the largest, or z if that
  /// column is 0 or not finite.
  [[nodiscard]] Eigen::Vector3d longest_column() const noexcept {
    Eigen::Vector3d column(xx, xy, xz);
    if (yy > xx && yy >= zz) column = {xy, yy, yz};
    if (zz > xx && zz > yy) column = {xz, yz, zz};
    const double length = length_in_order(column);
    return length > 0 ? Eigen::Vector3d(column / length) : Eigen::Vector3d(0, 0, 1);
  }
};

/// Returns the second moments about the mean of `count` points, from the sums of the points and of
/// their products.
[[nodiscard]] inline Symmetric moments_about_mean(double count, const Eigen::Vector3d& sum,
                                                  const Symmetric& products) noexcept {
  const double x = sum[0] / count, y = sum[1] / count, z = sum[2] / count;
  return {products.xx - sum[0] * x, products.xy - sum[0] * y, products.xz - sum[0] * z,
          products.yy - sum[1] * y, products.yz - sum[1] * z, products.zz - sum[2] * z};
}

/// Returns a unit vector at a right angle to a unit vector.
[[nodiscard]] inline Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& v) noexcept {
  Eigen::Vector3d axis(1, 0, 0);
  if (std::abs(v[1]) < std::abs(v[0])) axis = {0, 1, 0};
  if (std::abs(v[2]) < std::abs(v[0]) && std::abs(v[2]) < std::abs(v[1])) axis = {0, 0, 1};
  const Eigen::Vector3d across = cross_in_order(v, axis);
  return scaled(1 / length_in_order(across), across);
}

/// Returns a unit vector close to the axis of the smallest eigenvalue of second moments. The
/// adjugate has its largest eigenvalue there, and the eighth power of the adjugate a far larger
/// one. If two eigenvalues hardly differ, the vector lies between their axes. For points of a line
/// it is some vector across the line. + - × ÷ √ only.
[[nodiscard]] inline Eigen::Vector3d least_axis(const Symmetric& moments) noexcept {
  Symmetric power = moments.adjugate();
  const double trace = moments.trace();
  if (!(power.trace() > 0x1p-40 * (trace * trace))) {
    return any_perpendicular(moments.longest_column());
  }
  for (int i = 0; i < 3; ++i) power = power.squared();
  return power.longest_column();
}

}  // namespace ist
