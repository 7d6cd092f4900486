#pragma once

#include <Eigen/Geometry>

#include "ist/voxel/lattice.h"

namespace ist {

/// Whether a pose is accepted as a rigid motion. kEither: within rounding of the limit.
enum class Rigidity { kRigid, kEither, kNone };

/// Decides by the guarantee of poses. All numbers are finite, and the last row is 0 0 0 1. No entry
/// of RᵀR - I exceeds 1e-3, and R does not mirror. The singular values of R are not all above
/// 1 + 1e-5, and not all below 1 - 1e-5.
[[nodiscard]] Rigidity rigidity_of(const Eigen::Isometry3d& pose);

/// The motion from the moving tree's frame to the fixed tree's, by which the verifier moves leaves.
struct FrameMotion {
  Eigen::Isometry3d motion;
  double error;  ///< bound of the distance to a query's translation, which is rounded; mesh units
};

/// Projects a pose to the nearest rotation and composes it with the frames of two trees. By nothing
/// of the queries: they iterate in double and sum in twice that precision, and this decomposes into
/// singular values and sums, all in long double. Precondition: rigidity_of(pose) is not kNone.
[[nodiscard]] FrameMotion frame_motion(const Eigen::Isometry3d& pose, const Lattice& fixed,
                                       const Lattice& moving);

}  // namespace ist
