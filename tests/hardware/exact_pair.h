#pragma once

#include <gmpxx.h>

#include <Eigen/Geometry>

#include "hardware/pair_walk.h"
#include "support/exact.h"

namespace ist::test {

class Random;

/// Two trees at a pose in rational numbers: what the circuit answers approximately. It takes from
/// the library the pose made rigid and the table, and computes with nothing else of it.
class ExactFrames {
 public:
  ExactFrames(const Eigen::Isometry3d& pose, const Lattice& fixed, const Lattice& moving);

  /// From the fixed ball's centre to the moving one's, units.
  [[nodiscard]] ExactPoint between(const HardwareNode& fixed, const HardwareNode& moving) const;

  /// Whether the balls touch when the sum of their radii is times `scale`.
  [[nodiscard]] bool touch(const HardwareNode& fixed, const HardwareNode& moving,
                           const mpq_class& scale = 1) const;

  /// A moving centre in the fixed frame, units.
  [[nodiscard]] ExactPoint moved(const std::array<mpq_class, 3>& centre) const;

 private:
  std::array<ExactPoint, 3> rows_;  // of the rotation, times ratio
  ExactPoint translation_;
  mpq_class ratio_;
};

/// A lattice of 2^depth voxels whose tree's frame is that of the mesh. Where `voxel_size` is 12, a
/// unit is 1.
[[nodiscard]] Lattice centred_lattice(int depth, double voxel_size = 12);

/// A node at random: any mask but 0, and a centre that nodes of its level have.
[[nodiscard]] HardwareNode random_node(Random& random, int depth, int level);

/// The pose with this rotation at which the balls of two nodes, in centred lattices, are
/// `part` of the sum of their radii apart in `direction`, but for double's rounding.
[[nodiscard]] Eigen::Isometry3d pose_at(const Eigen::Matrix3d& rotation,
                                        const Lattice& fixed_lattice, const Lattice& moving_lattice,
                                        const HardwareNode& fixed, const HardwareNode& moving,
                                        const Eigen::Vector3d& direction, double part);

}  // namespace ist::test
