#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "answers/occlusion/bite.h"

namespace ist::answers {

/// A surface, and how far its vertices are from the other one.
struct FacingBody {
  FacingBody(const TriangleMesh& of, std::span<const SurfaceDistance> found,
             const Eigen::Isometry3d& place)
      : mesh(of), vertices(found), to_fixed(place) {}
  FacingBody(const BiteBody& body)  // NOLINT(google-explicit-constructor): it is the same body
      : FacingBody(*body.mesh, body.surface.vertices, body.to_fixed) {}

  const TriangleMesh& mesh;
  std::span<const SurfaceDistance> vertices;  ///< NaN beyond the reach
  Eigen::Isometry3d to_fixed;
};

/// A triangle whose corners are all within the reach; fixed coordinates.
struct NearTriangle {
  Eigen::Vector3d corner;
  Eigen::Vector3d area;  ///< twice the area, along the outer normal
  double distance;       ///< the least of its corners; negative inside the other body
};

/// Returns the triangles of a body that are within the reach of the other one.
[[nodiscard]] std::vector<NearTriangle> near_triangles(const FacingBody& body);

/// Returns the unit vector from the fixed body to the moving one, across the surfaces that face
/// each other; fixed coordinates.
///
/// It is the difference of the bodies' outer normals, summed over the triangles within the reach
/// and weighted by area and nearness; or the axis of fixed coordinates within 25° of it, so that
/// pictures of a series compare. If the normals cancel out, it is the axis of most of the area,
/// and if nothing is within the reach, the axis with the largest difference of the boxes'
/// middles; both point to the moving body's middle.
[[nodiscard]] Eigen::Vector3d direction_between(const FacingBody& fixed, const FacingBody& moving,
                                                double reach);

/// How two bodies face each other. Unit vectors at right angles, fixed coordinates.
struct BiteDirections {
  Eigen::Vector3d towards;  ///< from the fixed body to the moving one
  Eigen::Vector3d across;   ///< to the first of the sides
  Eigen::Vector3d front;    ///< to the front teeth
};

/// Returns the directions of two bodies: `towards` by direction_between(). If the user did not name
/// the front, it is the narrower end of the surfaces within the reach, as in dental arches. If both
/// ends are as wide, it is opposite to `fore_aft`.
[[nodiscard]] BiteDirections directions_of(const FacingBody& fixed, const FacingBody& moving,
                                           double reach, const Division& sides,
                                           const Division& fore_aft);
[[nodiscard]] BiteDirections directions_of(const Bite& bite);

}  // namespace ist::answers
