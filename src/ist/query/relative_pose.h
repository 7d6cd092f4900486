#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/api.h"
#include "ist/base/ordered_vector.h"
#include "ist/tree/frame_origin.h"

namespace ist {

/// A rigid motion from the moving tree's frame to the fixed tree's: y = rotation · x + translation.
struct RelativePose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

/// Composes the motion between two trees' frames from `pose`, which maps moving mesh coordinates to
/// fixed mesh coordinates and is first projected to a rigid motion. Returns nothing where it cannot
/// be projected (project_to_rigid).
///
/// The translation is summed in twice the precision of double, so its error is 2⁻⁵² of its own
/// length, wherever the scene lies. Cost: some 500 flops, no allocation.
[[nodiscard]] std::optional<RelativePose> relative_pose(const Eigen::Isometry3d& pose,
                                                        const FrameOrigin& fixed,
                                                        const FrameOrigin& moving) noexcept;

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

/// Returns the same motion as a pose.
[[nodiscard]] IST_LOOP_API Eigen::Isometry3d to_isometry(const RelativePose& pose) noexcept;

/// Returns how far any point of a box is at one pose from where it is at another. A displacement is
/// affine in the point, so a corner has the longest way.
[[nodiscard]] inline double longest_way(const Eigen::AlignedBox3d& box, const RelativePose& from,
                                        const RelativePose& to) noexcept {
  double most = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
    const double way = square_in_order(difference(moved(from, corner), moved(to, corner)));
    most = way > most ? way : most;
  }
  return std::sqrt(most);
}

}  // namespace ist
