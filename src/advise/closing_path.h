#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "advise/exact_bodies.h"

namespace ist {

/// One of the six directions along the axes of the fixed mesh.
struct AxisDirection {
  int axis = 0;   ///< 0, 1, 2: x, y, z
  int sign = +1;  ///< +1 or -1

  [[nodiscard]] Eigen::Vector3d vector() const noexcept {
    Eigen::Vector3d unit = Eigen::Vector3d::Zero();
    unit[axis] = sign;
    return unit;
  }
};

/// The poses of a closing path that are timed, if nobody says otherwise.
inline constexpr std::size_t kClosingPoses = 12;

/// A straight closing path of a moving body to a fixed one. Offsets on it are displacements of the
/// moving body from its stored place in the open direction, mesh units.
struct ClosingPath {
  Eigen::Vector3d open_direction;  ///< unit vector in which the moving body leaves
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< the body's constant rotation
  Eigen::Vector3d about = Eigen::Vector3d::Zero();     ///< centre of rotation, mesh units
  double begin = 0;                                    ///< offset shortly before first contact
  double first_contact = 0;  ///< offset; not free here, free at `accuracy` more
  double end = 0;            ///< smallest offset: the stored place, or behind it
  double accuracy = 0;       ///< width of the interval of first contact

  /// Returns the pose at an offset, mesh units.
  [[nodiscard]] Eigen::Isometry3d pose(double offset) const noexcept;
  /// Returns evenly spaced poses from begin to end. Precondition: count >= 2.
  [[nodiscard]] std::vector<Eigen::Isometry3d> poses(std::size_t count = kClosingPoses) const;
};

/// Returns the direction in which the moving body's bounding box leaves the fixed one's soonest.
[[nodiscard]] AxisDirection shortest_open_direction(const Eigen::AlignedBox3d& fixed,
                                                    const Eigen::AlignedBox3d& moving);

/// Finds the closing path to the stored place, or to 1 % of the smaller body's diagonal past first
/// contact if that is deeper. If the bodies are not free at the stored place, opens them by
/// doubling steps until they are, so it finds one of the nearest openings; if they are free, closes
/// them until they are not. All decisions are made on triangles (ExactBodies::free).
///
/// Returns nothing if the free bodies pass each other. May miss an intersection shorter than 1/1024
/// of the smaller body's extent, or than 1/4096 of the way past each other. Cost: some 50 calls of
/// ExactBodies; 4,000 where bodies pass each other at a small distance.
[[nodiscard]] std::optional<ClosingPath> find_closing_path(ExactBodies& bodies,
                                                           AxisDirection open_direction);

/// Returns tilted paths beside `path`, because bodies seldom meet exactly as stored: six paths,
/// each tilted by 20 degrees to another side, with the moving body turned by 3 degrees about
/// another axis through the centre of its box. Each ends at first contact. Leaves out a path
/// without a free offset to begin at, or past the fixed body.
///
/// Cost: one find_closing_path each.
[[nodiscard]] std::vector<ClosingPath> paths_beside(ExactBodies& bodies, const ClosingPath& path);

}  // namespace ist
