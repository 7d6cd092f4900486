#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {

/// The separating axes of a cube of one body and a cube of the other, at one rotation.
class CubeAxes {
 public:
  /// The shrinking of a cube on each side, as a fraction of its edge.
  static constexpr double kShrink = 1e-6;

  /// Computes the axes for both edges, mesh units; `rotation` maps the second body's axes to the
  /// first's. The centres' distance is uncertain by `tolerance`, mesh units.
  CubeAxes(double first_edge, double second_edge, const Eigen::Matrix3d& rotation,
           double tolerance = 0);

  /// Returns whether two cubes surely intersect; `apart` is the vector from the first centre to the
  /// second, mesh units. Misses only pairs that a motion of 4e-6 of both edges, or of twice
  /// the tolerance, would separate.
  [[nodiscard]] bool surely_meet(const Eigen::Vector3d& apart) const noexcept;

 private:
  struct Axis {
    Eigen::Vector3d direction;
    double extent;  // sum of both cubes' half extents along `direction`
  };
  std::vector<Axis> axes_;
};

/// Returns the triangles of a leaf, clipped to its closed cube, in the tree's frame. Precondition:
/// tree.triangles(); `code` is the leaf's Morton code.
[[nodiscard]] std::vector<ClippedTriangle> leaf_polygons(const SphereTree& tree, std::uint32_t leaf,
                                                         std::uint64_t code);

/// Returns whether two convex polygons surely cross: a line in one would still pass through a
/// triangle of the other if each corner moved by `tolerance`. False for polygons that only touch or
/// are coplanar.
[[nodiscard]] bool surely_cross(const ClippedTriangle& a, const ClippedTriangle& b,
                                double tolerance) noexcept;

}  // namespace ist
