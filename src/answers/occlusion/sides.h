#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>

#include "ist/measure/occlusion.h"
#include "ist/mesh/mesh.h"

namespace ist::answers {

/// A plane across the fixed body that parts shares in two, and the names of its sides.
struct Division {
  Eigen::Vector3d direction;  ///< of unit length, towards the first side
  double at = 0;              ///< the dividing plane: direction · x, mesh units
  bool assumed = true;        ///< whether the plane is the middle of the box, not the user's
  std::string first, second;  ///< such as "left" and "right", or "+x" and "-x"
};

/// The geometric shares of one surface on both sides of a division, per cent, also for a thinner
/// and a thicker foundation. They are no forces.
struct Balance {
  /// All 0 if nothing is pressed, as may happen with a thinner foundation.
  struct Shares {
    double first = 0, second = 0;
    double asymmetry = 0;  ///< 100 |first - second| / (first + second)
  };
  Shares shares, thinner, thicker;
  /// The centre of the share: Σ p x / Σ p, fixed coordinates.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

/// Returns the balance of a surface, or nothing if no region has a share. `to_fixed` maps the mesh
/// to fixed coordinates. A triangle counts to the side of its middle, and on the plane half to
/// each.
[[nodiscard]] std::optional<Balance> balance_of(const SurfaceOcclusion& surface,
                                                const TriangleMesh& mesh,
                                                const Eigen::Isometry3d& to_fixed,
                                                const Division& division);

/// The patient's sides, as a user names them. Nothing is guessed from the shape of a mesh.
struct SideOptions {
  std::string frame;    ///< "lps" or "ras": +x is the patient's left, or right; empty: not said
  std::string left;     ///< x,y,z: the direction of the patient's left
  std::string front;    ///< x,y,z: the direction of the patient's front
  std::string midline;  ///< x,y,z: a point of the plane between left and right
};

/// Returns how shares are parted by side, and from front to back. Sides are called left and right,
/// anterior and posterior only if the user or the files name them; else by the axes, +x and -x, +y
/// and -y. Planes that are not named go through the middle of `box`, fixed coordinates, and are
/// marked as assumed.
///
/// @param of_files the frame that the bodies' files name
///
/// Throws a Refusal for words without a direction, and for options that contradict each other or
/// the files.
[[nodiscard]] std::pair<Division, Division> divisions(const SideOptions& options,
                                                      PatientFrame of_files,
                                                      const Eigen::AlignedBox3d& box);

}  // namespace ist::answers
