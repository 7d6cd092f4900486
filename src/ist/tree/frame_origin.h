#pragma once

#include <Eigen/Core>
#include <array>

#include "ist/voxel/lattice.h"

namespace ist {

/// The origin of a tree's frame in mesh coordinates: a corner plus `half` along each axis. The sum
/// is exact as a pair of numbers, and rounded as one.
struct FrameOrigin {
  std::array<double, 3> corner{};
  double half = 0;

  FrameOrigin() = default;
  /// The centre of the root cube: the grid's corner plus half the cube's edge.
  FrameOrigin(const Lattice& lattice) noexcept
      : corner(lattice.corner), half(0.5 * lattice.edge(lattice.depth)) {}
  /// A point, of a tree without voxels.
  FrameOrigin(const Eigen::Vector3d& point) noexcept : corner{point[0], point[1], point[2]} {}

  /// Returns the origin, rounded.
  [[nodiscard]] Eigen::Vector3d rounded() const noexcept {
    return {corner[0] + half, corner[1] + half, corner[2] + half};
  }
};

}  // namespace ist
