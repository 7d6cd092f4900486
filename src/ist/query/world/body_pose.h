#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace ist {

/// A rigid motion from a body's mesh coordinates to the world's, or from one body's to another's.
struct BodyPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// Returns a pose projected to a rigid motion, or nothing where it cannot be (project_to_rigid).
[[nodiscard]] std::optional<BodyPose> body_pose(const Eigen::Isometry3d& pose) noexcept;

/// Returns the motion from b's mesh coordinates to a's, a⁻¹ b. Each number is summed in twice the
/// precision of double and rounded once: the translation is right to within 2⁻⁵² of its own length,
/// wherever the two bodies lie. No number is finite where no double holds
/// it: then the bodies are over a third of the largest double apart.
[[nodiscard]] BodyPose between(const BodyPose& a, const BodyPose& b) noexcept;

[[nodiscard]] Eigen::Isometry3d to_isometry(const BodyPose& pose) noexcept;

}  // namespace ist
