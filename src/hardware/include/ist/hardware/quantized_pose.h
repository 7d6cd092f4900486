#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "ist/base/api.h"
#include "ist/hardware/pair_test.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

struct Lattice;

/// The motion between two trees' frames in fixed point: the circuit's registers, and the map of its
/// moving centres. Units are defined in pair_test.h; a moving unit is a sixth of half a moving
/// leaf's edge.
struct QuantizedPose {
  PairRegisters registers;                    ///< for the pair test
  std::array<std::int32_t, 9> rotation{};     ///< moving to fixed units, columns first; Q3.28
  std::array<std::int64_t, 3> translation{};  ///< between the frames, units; Q23.28
};

/// Converts a pose to fixed point. `pose` maps moving mesh coordinates to fixed mesh coordinates,
/// and is first projected to a rigid motion (project_to_rigid).
///
/// Throws kPoseInvalid if it is not rigid; kPolicyMissing if a tree lacks voxels; kFixedPointRange
/// if the moving voxels are at least 8 times as large as the fixed ones, or if the pad or any
/// centre that move_centre could return does not fit its format.
[[nodiscard]] IST_API QuantizedPose quantize_pose(const Eigen::Isometry3d& pose,
                                                  const SphereTree& fixed,
                                                  const SphereTree& moving);
/// Converts a pose between two lattices, for the library's own tests: no installed header defines
/// Lattice.
[[nodiscard]] IST_API QuantizedPose quantize_pose(const Eigen::Isometry3d& pose,
                                                  const Lattice& fixed, const Lattice& moving);

/// Returns the centre of a moving node's cube in the fixed tree's frame, units, Q23.8, rounded
/// down.
///
/// @param pose   made by quantize_pose()
/// @param centre moving units; within the root cube of the pose's moving lattice
[[nodiscard]] IST_API std::array<std::int32_t, 3> move_centre(
    const QuantizedPose& pose, const std::array<std::int32_t, 3>& centre) noexcept;

/// Returns the registers for a rotation and for moving voxels `ratio` times as large as the fixed
/// ones. Throws kFixedPointRange if ratio is not between 0 and 8.
[[nodiscard]] IST_API PairRegisters make_registers(const Eigen::Matrix3d& rotation, double ratio,
                                                   std::uint16_t pad);

}  // namespace ist
