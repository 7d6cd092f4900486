#pragma once

#include <optional>
#include <string>

#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// The two trees of a query, and the sphere policy that it uses.
struct Bodies {
  SphereTree fixed, moving;
  SpherePolicy policy;
  /// Mesh units; empty of a mesh that got no voxels, but one as large as itself.
  std::optional<double> fixed_voxel_size{}, moving_voxel_size{};

  /// Returns whether both bodies have voxels: leaf pairs and contacts are answers about voxels.
  [[nodiscard]] bool have_voxels() const { return fixed_voxel_size && moving_voxel_size; }
  /// Returns the largest extent of the smaller body. Cost: as of box_of().
  [[nodiscard]] double extent() const;
  /// Returns the unit that a body's tree was told, which is the other's too: load_bodies() refuses
  /// two that differ. kUnknown where neither was told one.
  [[nodiscard]] LengthUnit unit() const;
};

/// Returns a warning that begins with `name`, if a voxel is over 1/50 of the largest extent.
[[nodiscard]] std::optional<std::string> voxel_warning(const std::string& name, double voxel_size,
                                                       double extent);

/// Throws kTrianglesMissing, naming the body, where a tree holds no triangles.
void require_triangles(const Bodies& bodies);

}  // namespace ist::cli
