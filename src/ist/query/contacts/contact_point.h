#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace ist {

/// A place where two bodies touch, in fixed mesh coordinates and mesh units: what the leaf pairs of
/// one moving leaf, or of a few together, come to.
struct ContactPoint {
  Eigen::Vector3d position;  ///< half way between the two surfaces
  Eigen::Vector3d normal;    ///< of unit length, from the fixed body to the moving one
  /// How deep the surfaces overlap along the normal, negative where they are apart; from -2s to s,
  /// with s the mean of the two voxel sizes. Leaf pairs do not show deeper overlap.
  double depth;
  /// An area, mesh units squared, to be compared with other weights of the same two trees: it grows
  /// with the surface that touches, and falls to 0 where a contact ends.
  double weight;
};

/// A force and its torque about some point that is named.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();

  /// The same wrench about a point that is `by` away from the one before.
  [[nodiscard]] Wrench about(const Eigen::Vector3d& by) const noexcept {
    return {force, torque - by.cross(force)};
  }
};

/// Sums over all leaf pairs, none merged or left out, of what acts on the moving body: the weight w
/// of a pair, its unit normal n, depth d and position p. They are Lipschitz in the pose, see
/// ContactRates; forces are made of these, and of points only where it matters where they act.
///
/// Pressure is a constant force an area. A spring grows with the overlap from nothing at d = -2s
/// on, so that it pushes wherever leaves touch, and never pulls; one that begins at another depth
/// d0 is spring - (d0 + 2s) · pressure, for a stiffness of 1.
struct ContactSums {
  double weight = 0;        ///< sum of w, mesh units squared
  Wrench pressure;          ///< sum of w n, and of p × w n
  Wrench spring;            ///< sum of w (d + 2s) n, and of p × w (d + 2s) n, or of what d is over
                            ///< another least depth
  std::uint64_t pairs = 0;  ///< of leaves with a weight above 0
  /// Torques are about this point, fixed mesh coordinates: the origin of the fixed tree's frame.
  Eigen::Vector3d about = Eigen::Vector3d::Zero();
};

}  // namespace ist
