#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "ist/base/error.h"
#include "ist/voxel/morton.h"

namespace ist {

/// The voxel grid of one body and the octree's cubes over it.
///
/// In lattice units the grid's corner is at 0 and a voxel's edge is 1, so every box is a pair of
/// integers, and a scene scaled by a power of two gives the same numbers. The tree's frame has the
/// axes and units of the mesh and its origin at the root cube's centre.
struct Lattice {
  static constexpr std::uint32_t kMaxCells = 1u << 16;
  /// The relative pad of the build: geometry this close to a cube, as a fraction of the grid's
  /// extent, counts as inside. Exceeds the rounding of lattice coordinates (2⁻⁵² of the extent)
  /// many times.
  static constexpr double kPad = 1e-9;

  /// The largest voxel size, as a multiple of the mesh's extent. With larger voxels the mesh would
  /// be lost in the rounding of its own tree's frame.
  static constexpr double kMaxRelativeSize = 1000;

  std::array<double, 3> corner{};  ///< minimum of the mesh's bounding box, mesh units
  double voxel_size = 1;           ///< edge of a voxel, mesh units
  std::uint32_t cells = 1;         ///< voxels along each axis, at most kMaxCells
  int depth = 0;                   ///< level of the root: ceil(log2(cells))

  friend bool operator==(const Lattice&, const Lattice&) = default;

  [[nodiscard]] Eigen::Vector3d to_lattice(const Eigen::Vector3d& vertex) const noexcept {
    return {(vertex[0] - corner[0]) / voxel_size, (vertex[1] - corner[1]) / voxel_size,
            (vertex[2] - corner[2]) / voxel_size};
  }

  /// The pad in lattice units.
  [[nodiscard]] double pad() const noexcept { return kPad * cells; }

  /// The root cube's centre on each axis, in lattice units.
  [[nodiscard]] double root_centre() const noexcept {
    return 0.5 * static_cast<double>(std::uint64_t{1} << depth);
  }

  /// The root cube's centre, the origin of the tree's frame, in mesh coordinates; rounded.
  [[nodiscard]] Eigen::Vector3d origin() const noexcept {
    const double half = voxel_size * root_centre();
    return {corner[0] + half, corner[1] + half, corner[2] + half};
  }

  /// The edge of a cube at `level`, mesh units.
  [[nodiscard]] double edge(int level) const noexcept {
    return voxel_size * static_cast<double>(std::uint64_t{1} << level);
  }
};

/// Returns the lattice over a box in mesh units: cells = max(1, ceil(largest extent / voxel_size)).
///
/// Throws kVoxelSizeInvalid if the size is not positive and finite or is over 1,000 times the
/// extent, kMeshExtent if the largest extent is zero or outside [1e-12, 1e15], and
/// kVoxelSizeTooSmall, with the smallest valid size, if the grid would need more than 2^16 voxels
/// an axis.
[[nodiscard]] Lattice make_lattice(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max,
                                   double voxel_size);

/// Returns the error of a box whose extent no mesh may have, or nullopt.
[[nodiscard]] std::optional<Error> extent_flaw(const Eigen::Vector3d& box_min,
                                               const Eigen::Vector3d& box_max);

/// Returns the error that make_lattice would throw, or nullopt.
[[nodiscard]] std::optional<Error> lattice_flaw(const Eigen::Vector3d& box_min,
                                                const Eigen::Vector3d& box_max, double voxel_size);

/// Returns `size` rounded up to some significant digits, 2 or more, for the remedy in an error
/// text.
[[nodiscard]] double round_to_nice_number(double size, int digits = 3);

}  // namespace ist
