#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist::answers {

/// The two trees of a query, and the sphere policy that it uses.
struct Bodies {
  SphereTree fixed, moving;
  SpherePolicy policy;                          ///< means nothing if a body lacks voxels
  LengthUnit told_unit = LengthUnit::kUnknown;  ///< by the user, for trees without a unit
  double moving_factor = 1;                     ///< that converted the lengths of the moving mesh
  /// How messages call the bodies: by the names of their files, if there are any.
  std::string fixed_name = "the fixed body", moving_name = "the moving body";
  /// Whether a mesh has a border. False for trees, because they do not tell.
  bool fixed_has_border = false, moving_has_border = false;

  /// Returns whether both bodies have voxels: leaf pairs and contacts are answers about voxels.
  [[nodiscard]] bool have_voxels() const { return fixed.has_voxels() && moving.has_voxels(); }
  /// Returns the policy of a query; nothing if a body lacks voxels.
  [[nodiscard]] std::optional<SpherePolicy> query_policy() const {
    return have_voxels() ? std::optional(policy) : std::nullopt;
  }
  /// Returns the largest extent of the smaller body. Cost: as of box_of().
  [[nodiscard]] double extent() const;
  /// Returns the unit of a body's lengths. It is the other's too, because load_bodies() converts or
  /// refuses two that differ. kUnknown if neither is known.
  [[nodiscard]] LengthUnit unit() const;
  /// Returns the frame that a body's file names. It is the other's too, because load_bodies()
  /// refuses two that differ. kUnknown if no file names one.
  [[nodiscard]] PatientFrame frame() const;
};

/// Returns a warning that begins with `name`, if a voxel is over 1/50 of the largest extent.
[[nodiscard]] std::optional<std::string> voxel_warning(const std::string& name, double voxel_size,
                                                       double extent);

/// Throws kTrianglesMissing with the name of the body if a tree holds no triangles.
void require_triangles(const Bodies& bodies);

/// Returns a point of the fixed triangle that is nearest to the moving one, fixed coordinates. It
/// lies on both if they intersect. Cost: 0.2 ms.
[[nodiscard]] Eigen::Vector3d shared_point(const Bodies& bodies, const TrianglePair& pair,
                                           const Eigen::Isometry3d& pose);

}  // namespace ist::answers
