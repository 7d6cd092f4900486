#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist {

/// The least distance of a splint from either arch, in space; mm.
inline constexpr double kSplintClearance = 0.2;

/// A rectangle of the occlusal plane; mm.
struct PlaneBox {
  Eigen::Vector2d min, max;
};

/// The heights, by square cells of the occlusal plane, below which a solid may fill a cell: no
/// point in a cell's column that lies below its height is within kSplintClearance of the surface,
/// nor has any of the surface below it.
class ClearanceMap {
 public:
  /// @param surface of which all that lies above or near `area` counts, at any height
  /// @param area    where the map has cells; whole millimetres
  ClearanceMap(const TriangleMesh& surface, const PlaneBox& area);

  /// Returns the least height of the cells that meet a rectangle inside `area`. Infinite where
  /// there is no surface.
  [[nodiscard]] double lowest(const PlaneBox& box) const;

 private:
  void lower_to(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  void subtract_clearance();

  Eigen::Vector2d corner_;
  std::ptrdiff_t width_, height_;
  std::vector<double> heights_;  // row by row; at first, of the surface's lowest points
};

}  // namespace ist
