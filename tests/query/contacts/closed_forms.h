#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

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

/// Two solids at a pose with the greatest overlap `depth`. A depth below 0 is a distance.
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

/// Errors of contacts at points with two smooth surfaces: depths in voxels, normals in degrees.
struct FormErrors {
  std::size_t points = 0;          ///< in all
  std::size_t smooth = 0;          ///< points with two smooth surfaces
  bool finite = true;              ///< whether all of them are numbers
  double depth = 0, depths = 0;    ///< the largest, and the sum of all
  double normal = 0, normals = 0;  ///< the largest, and the sum of all
  double deepest = -2;             ///< of any point

  void add(const FormErrors& other);
  [[nodiscard]] double mean_depth() const { return depths / static_cast<double>(smooth); }
  [[nodiscard]] double mean_normal() const { return normals / static_cast<double>(smooth); }
};

[[nodiscard]] SphereTree tree_of_solid(const Solid& solid, double voxel_size);

/// Returns the errors of the bodies' contacts at an overlap of `depth` voxels, reduced to at most
/// `most` points. The closed form gives the true depth and normal at each point. A depth is defined
/// from -2s to s.
[[nodiscard]] FormErrors form_errors(const ClosedForm& form, const SphereTree& fixed,
                                     const SphereTree& moving, SpherePolicy policy, double depth,
                                     std::size_t most = 1 << 14);

}  // namespace ist::test
