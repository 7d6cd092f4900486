#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/measure/signed_distance.h"

namespace ist {

/// The motion of a body from one pose to another, fixed coordinates: as six numbers about a named
/// point, and as a screw.
struct PoseChange {
  Eigen::Vector3d about;  ///< the named point, at the first pose
  /// The way of that point, mesh units. It depends on the point if the body turns.
  Eigen::Vector3d translation;
  /// The turn as a vector along its axis, as long as its angle, radians: 0 to pi, counterclockwise
  /// seen against the vector. It does not depend on the point. Of small turns the components are
  /// the angles about x, y and z.
  Eigen::Vector3d rotation;
  double angle = 0;  ///< of the screw, radians: 0 to pi
  /// The way along the screw's axis, mesh units; negative against it, and never of a translation.
  double along = 0;
  /// Of the screw, of unit length: the axis of the turn. The direction of a translation; 0 if the
  /// body does not move.
  Eigen::Vector3d axis;
  /// The axis' nearest point to `about`; empty if the body does not turn.
  std::optional<Eigen::Vector3d> axis_point;
  double rotation_error = 0;  ///< of the given poses, the larger rotation_error()
};

/// Returns the motion that takes a body from the pose `before` to the pose `after`.
///
/// @param before the first pose: maps body to fixed coordinates
/// @param after  the second pose
/// @param about  the named point, fixed coordinates, carried by the body from its first pose
///
/// The same bits on every instruction set. Throws kPoseInvalid, and kArgumentInvalid for a point
/// that is not finite, or farther than 1e15. Source of the screw: Motion::between().
[[nodiscard]] IST_API PoseChange pose_change(const Eigen::Isometry3d& before,
                                             const Eigen::Isometry3d& after,
                                             const Eigen::Vector3d& about);

/// A contact as a comparison of two bites needs it.
struct PlacedContact {
  Eigen::Vector3d centre;  ///< fixed coordinates, mesh units
  int tooth = 0;           ///< its label; 0 if it has none
};

/// A contact of two bites. At least one of the indices is there.
struct ContactMatch {
  std::optional<std::uint32_t> before,  ///< its index in the first bite; empty: the contact is new
      after;                            ///< in the second bite; empty: the contact is lost
  double moved = 0;                     ///< the distance of both centres, mesh units; 0 of one
};

/// Matches the contacts of two bites by their place on the fixed body.
///
/// The two nearest centres are matched first, then the nearest of the rest, and so on, as far as
/// `within`. Two contacts with different teeth are never matched. A contact without a tooth matches
/// any. Returns the contacts of the first bite by their index, and then the new ones by theirs. An
/// exchange of the two bites exchanges new and lost, and nothing else.
///
/// @param before the contacts of the first bite
/// @param after  the contacts of the second bite
/// @param within mesh units: centres farther apart are two contacts
///
/// Allocates. Cost: 2 ns for each pair of contacts. Throws kArgumentInvalid for a centre that is
/// not finite, and for a `within` that is negative or NaN.
[[nodiscard]] IST_API std::vector<ContactMatch> match_contacts(
    std::span<const PlacedContact> before, std::span<const PlacedContact> after, double within);

/// Returns the change of the signed distance of each vertex, mesh units: after less before. So it
/// is negative if the vertex came nearer, or went deeper. NaN if either is beyond its reach, and if
/// the sign of one is known and of the other is not.
///
/// Throws kArgumentInvalid for maps of different sizes.
[[nodiscard]] IST_API std::vector<double> distance_change(std::span<const SurfaceDistance> before,
                                                          std::span<const SurfaceDistance> after);

}  // namespace ist
