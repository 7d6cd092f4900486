#pragma once

#include <Eigen/Core>

#include "ist/query/relative_pose.h"

/// Vectors component by component: added up in one order everywhere, and every number is read as
/// it was written. (Eigen reads two at a time; where they were just written one by one, that waits
/// for memory, 5 ns each time.)
namespace ist {

[[nodiscard]] inline double dot_in_order(const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
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
[[nodiscard]] inline Eigen::Vector3d turned(const RelativePose& pose,
                                            const Eigen::Vector3d& v) noexcept {
  const Eigen::Matrix3d& r = pose.rotation;
  return {(r(0, 0) * v[0] + r(0, 1) * v[1]) + r(0, 2) * v[2],
          (r(1, 0) * v[0] + r(1, 1) * v[1]) + r(1, 2) * v[2],
          (r(2, 0) * v[0] + r(2, 1) * v[1]) + r(2, 2) * v[2]};
}
[[nodiscard]] inline Eigen::Vector3d moved(const RelativePose& pose,
                                           const Eigen::Vector3d& point) noexcept {
  return sum(turned(pose, point), pose.translation);
}

}  // namespace ist
