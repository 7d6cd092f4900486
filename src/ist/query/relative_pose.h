#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/voxel/lattice.h"

namespace ist {

/// A rigid motion from the moving tree's frame to the fixed tree's: y = rotation · x + translation.
struct RelativePose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

/// The motion between two trees' frames for `pose`, which maps moving mesh coordinates to fixed
/// mesh coordinates, and is first projected to a rigid one; nothing where it is none
/// (project_to_rigid).
///
/// The translation is summed in twice the precision of double, so its error is 2⁻⁵² of its own
/// length, wherever the scene lies. Cost: some 500 flops, no allocation.
[[nodiscard]] std::optional<RelativePose> relative_pose(const Eigen::Isometry3d& pose,
                                                        const Lattice& fixed,
                                                        const Lattice& moving) noexcept;

}  // namespace ist
