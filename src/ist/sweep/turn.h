#pragma once

#include <Eigen/Geometry>
#include <numbers>

/// Turns by + - × ÷ alone: their bits are the same everywhere.
namespace ist {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// Returns the rotation of the quaternion w + x i + y j + z k, of any length but 0.
[[nodiscard]] Eigen::Matrix3d rotation_of(double w, double x, double y, double z) noexcept;

/// Returns the motion that turns about the point `about`.
[[nodiscard]] Eigen::Isometry3d turn_about(const Eigen::Matrix3d& rotation,
                                           const Eigen::Vector3d& about) noexcept;

}  // namespace ist
