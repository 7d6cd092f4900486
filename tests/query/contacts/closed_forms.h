#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// A body whose surface is known, in its own frame, mm.
struct Solid {
  std::function<TriangleMesh(double edge)> mesh;  ///< of triangles about so long
  /// How far a point is outside, less than 0 inside; near the surface.
  std::function<double(const Eigen::Vector3d&)> distance;
  /// Whether the surface is smooth, with radii of curvature above `radius`, round a point.
  std::function<bool(const Eigen::Vector3d&, double radius)> smooth;

  /// The gradient of the distance, by differences.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& at) const;
};

/// Two of them at a pose where they overlap by `depth` at the deepest, or are apart by that much.
struct ClosedForm {
  std::string name;
  Solid fixed, moving;
  std::function<Eigen::Isometry3d(double depth)> pose;

  /// How deep they overlap at a point, along the normals there; fixed coordinates.
  [[nodiscard]] double depth(const Eigen::Isometry3d& placed, const Eigen::Vector3d& at) const;
  /// From the fixed body to the moving one.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Isometry3d& placed,
                                       const Eigen::Vector3d& at) const;
};

/// Sphere on sphere, sphere on plane, cylinder in a bore, boxes face on face and edge on face,
/// torus on torus: of some 4 mm, turned, so that no face lies in the grid, but for one pair of
/// boxes.
[[nodiscard]] const std::vector<ClosedForm>& closed_forms();

}  // namespace ist::test
