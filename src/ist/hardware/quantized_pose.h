#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "ist/base/api.h"
#include "ist/hardware/pair_test.h"
#include "ist/voxel/lattice.h"

namespace ist {

/// The motion between two trees' frames in fixed point: what the circuit's registers hold, and what
/// moves the centres that it is given. Units are those of pair_test.h; a moving unit is a sixth of
/// half a moving leaf's edge.
struct QuantizedPose {
  PairRegisters registers;
  std::array<std::int32_t, 9> rotation{};     ///< moving to fixed units, columns first; Q3.28
  std::array<std::int64_t, 3> translation{};  ///< between the frames, units; Q23.28
};

/// `pose` maps moving mesh coordinates to fixed mesh coordinates, and is first projected to a rigid
/// motion (project_to_rigid).
///
/// Throws kPoseInvalid where it is none, and kFixedPointRange where the moving voxels are 8 times
/// as large as the fixed ones or more, or where the pad or any centre that move_centre could give
/// does not fit its format.
[[nodiscard]] IST_API QuantizedPose quantize_pose(const Eigen::Isometry3d& pose,
                                                  const Lattice& fixed, const Lattice& moving);

/// The centre of a moving node's cube in the fixed tree's frame, units, Q23.8, rounded down.
///
/// @param centre in moving units; within the root cube of the lattice that the pose was made for
[[nodiscard]] IST_API std::array<std::int32_t, 3> move_centre(
    const QuantizedPose& pose, const std::array<std::int32_t, 3>& centre) noexcept;

/// The registers for a rotation and for moving voxels `ratio` times as large as the fixed ones.
/// Throws kFixedPointRange where ratio is not below 8.
[[nodiscard]] IST_API PairRegisters make_registers(const Eigen::Matrix3d& rotation, double ratio,
                                                   std::uint16_t pad);

}  // namespace ist
