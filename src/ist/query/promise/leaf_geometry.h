#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {

/// All that can separate a cube of one body from a cube of the other, at one rotation.
class CubeAxes {
 public:
  /// Cubes are taken a millionth of their edges smaller, on each side, than they are.
  static constexpr double kShrink = 1e-6;

  /// `rotation` turns the second body's axes to the first one's.
  CubeAxes(double first_edge, double second_edge, const Eigen::Matrix3d& rotation);

  /// Whether two cubes share a point for certain; `apart` is the second one's centre from the
  /// first one's. Missed are only pairs that a motion of 4e-6 of both edges would part.
  [[nodiscard]] bool surely_meet(const Eigen::Vector3d& apart) const noexcept;

 private:
  struct Axis {
    Eigen::Vector3d direction;
    double reach;  // of both cubes together, from their centres
  };
  std::vector<Axis> axes_;
};

/// The triangles of a leaf, clipped to its closed cube, in the tree's frame.
/// Precondition: tree.triangles(); `code` is the leaf's Morton code.
[[nodiscard]] std::vector<ClippedTriangle> leaf_polygons(const SphereTree& tree, std::uint32_t leaf,
                                                         std::uint64_t code);

/// Whether two convex polygons cross for certain: a line in one would still pass through a triangle
/// of the other if each corner moved by `tolerance`. Not those that only touch, nor those that lie
/// in one plane.
[[nodiscard]] bool surely_cross(const ClippedTriangle& a, const ClippedTriangle& b,
                                double tolerance) noexcept;

}  // namespace ist
