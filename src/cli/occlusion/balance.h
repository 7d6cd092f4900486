#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::cli {

/// A direction of the fixed body by which shares are parted in two, and the names of its ends.
struct Division {
  Eigen::Vector3d direction;  ///< of unit length, towards the first side
  double at = 0;              ///< the dividing plane: direction · x, mesh units
  bool assumed = true;        ///< whether the plane is the middle of the box, not the user's
  std::string first, second;  ///< such as "left" and "right", or "+x" and "-x"
};

/// The geometric shares of one surface on both sides of a division; of a foundation that is thinner
/// and thicker too. Per cent; they are no forces.
struct Balance {
  /// All 0 where nothing is pressed, as a thinner foundation may not be.
  struct Shares {
    double first = 0, second = 0;
    double asymmetry = 0;  ///< 100 |first - second| / (first + second)
  };
  Shares shares, thinner, thicker;
  /// Where the share has its centre: Σ p x / Σ p, fixed coordinates.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

/// Returns the balance of a surface; nothing where no region has a share. `to_fixed` maps the mesh
/// to fixed coordinates. A triangle counts to the side that its middle lies on, and on the plane
/// half to each.
[[nodiscard]] std::optional<Balance> balance_of(const SurfaceOcclusion& surface,
                                                const TriangleMesh& mesh,
                                                const Eigen::Isometry3d& to_fixed,
                                                const Division& division);

}  // namespace ist::cli
