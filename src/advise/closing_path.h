#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "ist/query/query.h"

namespace ist {

/// One of the six directions along the axes of the fixed mesh.
struct AxisDirection {
  int axis = 0;   ///< 0, 1, 2: x, y, z
  int sign = +1;  ///< +1 or -1
};

/// The poses of a closing path that are timed, if nobody says otherwise.
inline constexpr std::size_t kClosingPoses = 12;

/// A straight closing path of a moving body to a fixed one. Offsets on it are displacements of the
/// moving body from its stored place in the open direction, mesh units.
struct ClosingPath {
  Eigen::Vector3d open_direction;  ///< unit vector; the moving body leaves along it
  double begin = 0;                ///< offset shortly before first contact
  double first_contact = 0;        ///< offset; no triangles intersect from here on outward
  double end = 0;                  ///< smallest offset: the stored place, or behind it

  /// Returns the pose at an offset, mesh units.
  [[nodiscard]] Eigen::Isometry3d pose(double offset) const noexcept;
  /// Returns evenly spaced poses from begin to end. Precondition: count >= 2.
  [[nodiscard]] std::vector<Eigen::Isometry3d> poses(std::size_t count = kClosingPoses) const;
};

/// Returns the direction with the shortest way of the moving bounding box out of the fixed one.
[[nodiscard]] AxisDirection shortest_open_direction(const SphereTree& fixed,
                                                    const SphereTree& moving);

/// Finds the closing path to the stored place, or to 1 % of the smaller body's diagonal past first
/// contact if that is deeper. The body begins at its stored place if it is free there, and beyond
/// the fixed body if it is not. It closes until triangles intersect (first_contact()).
///
/// Returns nothing if the bodies pass each other. Cost: as first_contact(), once or twice.
/// @param exact a query of two trees with triangles; their voxel sizes do not matter
[[nodiscard]] std::optional<ClosingPath> find_closing_path(Query& exact,
                                                           AxisDirection open_direction);

}  // namespace ist
