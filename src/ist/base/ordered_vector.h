#pragma once

#include <Eigen/Core>
#include <cmath>

/// Vector operations written out by component: sums have one order everywhere, and each number is
/// loaded as it was stored. (Eigen adds in another order where it has no vectors, and loads two
/// numbers at a time, which waits 5 ns for memory if they were just stored one by one.)
namespace ist {

[[nodiscard]] inline double dot_in_order(const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
[[nodiscard]] inline double sum_in_order(const Eigen::Vector3d& v) noexcept {
  return (v[0] + v[1]) + v[2];
}
[[nodiscard]] inline double square_in_order(const Eigen::Vector3d& v) noexcept {
  return dot_in_order(v, v);
}
[[nodiscard]] inline double length_in_order(const Eigen::Vector3d& v) noexcept {
  return std::sqrt(square_in_order(v));
}
[[nodiscard]] inline Eigen::Vector3d difference(const Eigen::Vector3d& a,
                                                const Eigen::Vector3d& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Eigen::Vector3d sum(const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Eigen::Vector3d scaled(double by, const Eigen::Vector3d& v) noexcept {
  return {by * v[0], by * v[1], by * v[2]};
}
[[nodiscard]] inline Eigen::Vector3d cross_in_order(const Eigen::Vector3d& a,
                                                    const Eigen::Vector3d& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline void add_to(Eigen::Vector3d& sum, const Eigen::Vector3d& v) noexcept {
  sum[0] += v[0];
  sum[1] += v[1];
  sum[2] += v[2];
}

}  // namespace ist
