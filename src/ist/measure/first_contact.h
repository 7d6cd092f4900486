#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// A rigid motion from one pose to another: a screw, which turns about an axis and moves along it,
/// both evenly. A translation is a screw that does not turn. Its parameter goes from 0 to 1.
class IST_API Motion {
 public:
  /// The screw between two poses that turns least: by half a turn at most. Throws kPoseInvalid.
  [[nodiscard]] static Motion between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

  /// The screw from a pose about the axis through `point` along `direction`, fixed coordinates, by
  /// any angle, in radians, counterclockwise seen against the direction, and by `along` mesh units.
  /// The direction's length does not matter. Throws kPoseInvalid, and kArgumentInvalid for a number
  /// that is not finite, or a direction without a length.
  [[nodiscard]] static Motion screw(const Eigen::Isometry3d& from, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& direction, double angle, double along);

  /// The pose at a parameter; the bits are the same on every machine.
  [[nodiscard]] Eigen::Isometry3d at(double parameter) const noexcept;

  /// The way of the point that goes farthest, mesh units for the whole motion: each goes evenly.
  /// `points` in moving coordinates. Cost: 5 ns a point.
  [[nodiscard]] double longest_way(std::span<const Eigen::Vector3d> points) const noexcept;

  /// The unit vector along the axis, fixed coordinates: the direction of a translation. (0, 0, 1)
  /// if nothing moves.
  [[nodiscard]] Eigen::Vector3d axis() const noexcept { return {axis_[0], axis_[1], axis_[2]}; }
  /// The axis' nearest point to the origin, fixed coordinates. The origin if nothing turns.
  [[nodiscard]] Eigen::Vector3d point() const noexcept {
    return {centre_[0], centre_[1], centre_[2]};
  }
  /// The turn about the axis, radians: 0 to pi of between().
  [[nodiscard]] double angle() const noexcept { return angle_; }
  /// The way along the axis, mesh units.
  [[nodiscard]] double along() const noexcept { return along_; }
  /// Returns the velocity of a point of the moving body that is at `point`, fixed coordinates, mesh
  /// units for the whole motion. It depends on the place alone, not on the parameter.
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::Vector3d& point) const noexcept;

  /// Returns the vector along the axis whose length is the angle of the whole motion, rad.
  [[nodiscard]] Eigen::Vector3d turning() const noexcept {
    return {angle_ * axis_[0], angle_ * axis_[1], angle_ * axis_[2]};
  }

  /// How far the rotations of the given poses were from orthonormal: the larger rotation_error().
  [[nodiscard]] double rotation_error() const noexcept { return rotation_error_; }

 private:
  Motion() = default;

  // The motion x -> R x + translation after the first pose: R turns by parameter · angle, and the
  // translation is (1 - cos) centre - sin across + parameter · along · axis, with the angle's
  // sine and cosine, the axis' nearest point to the origin, and axis × centre. Plain numbers: the
  // alignment of Eigen's types depends on the instruction set.
  double rotation_[3][3], translation_[3];  // of the first pose
  double axis_[3], centre_[3], across_[3];
  double angle_, along_, rotation_error_;
};

/// When a moving body first meets the fixed one.
struct FirstContact {
  /// How the motion goes.
  enum class Status : std::uint8_t {
    kContact,  ///< at `upper` triangles intersect, before `lower` none do; see `passes`
    kNone,     ///< none intersect on the whole motion
    kGrazing,  ///< at `lower` the surfaces are within the tolerance; triangles may intersect from
               ///< `lower` to `upper`, but none were found, and none do elsewhere
    kTouchesAtStart,  ///< triangles intersect at the first pose
    kInsideAtStart,   ///< none do there, but a body lies inside the other, or a part of it
    kStopped,         ///< the budget or the caller ended the search: before `lower` none intersect
    kBusy,            ///< another thread is using the query
  };

  Status status = Status::kStopped;  ///< says which members count
  /// The parameter of the first contact lies in [lower, upper]. With kContact no point of the
  /// moving body goes farther than the tolerance from `lower` to `upper`, unless the surfaces
  /// grazed before: `grazed`. [0, 0] at the start; [1, 1] with kNone; [0, 1] if busy.
  double lower = 0,     ///< the parameter before which no triangles intersect
      upper = 1;        ///< the latest parameter of the contact
  bool grazed = false;  ///< the surfaces grazed before, and may have met unseen
  /// With kContact: `triangles` pass through each other between `lower` and `upper`, by a corner
  /// and a face or by two edges. They intersect on the way, but at no pose that was tried, and
  /// perhaps at none in double.
  bool passes = false;
  /// Triangles that intersect at `upper`, or pass through each other before.
  std::optional<TrianglePair> triangles = std::nullopt;
  /// The closest points of the triangles that meet first, at a pose before the contact that is
  /// known to be free, fixed coordinates. This pose is at `lower`, unless `grazed`. With
  /// kTouchesAtStart it is a common point of `triangles`. Empty without a contact.
  std::optional<NearPair> place = std::nullopt;
  /// The unit vector from the fixed to the moving body there: along the closest points, or, if
  /// their distance is rounding, along the last axis that parted the triangles. 0 without a place,
  /// with kTouchesAtStart, and if no axis is known.
  Eigen::Vector3d normal = {0, 0, 0};
  /// The distance of the surfaces at `lower`, mesh units: no more than the distance of the place.
  /// The lower end is 0. [0, infinity] if no triangles came within the tolerance.
  DistanceInterval distance{0, std::numeric_limits<double>::infinity()};
  /// The least tolerance that is reached, mesh units: 16 times the rounding of a pose.
  double narrowest = 0;
  /// Whether the surface of a body intersects itself: SphereTree::self_intersections(). Only
  /// kInsideAtStart depends on it. False if the bodies touch at the start.
  bool fixed_self_intersecting = false,  ///< the fixed body's surface
      moving_self_intersecting = false;  ///< the moving body's
  std::uint64_t distances = 0;           ///< lists of near pairs, and pairs that were measured
  std::uint64_t verdicts = 0;            ///< exact questions whether the bodies or a pair intersect
  double rotation_error = 0;             ///< Motion::rotation_error()
};
/// Returns the status' name, such as "touches-at-start", for logs and tests.
[[nodiscard]] IST_API const char* to_string(FirstContact::Status status) noexcept;

/// The options of first_contact().
struct FirstContactOptions {
  Budget budget = {};    ///< `tests` counts FirstContact::distances
  Proceed proceed = {};  ///< asked with the parameter that was reached, if it has grown
};

/// Finds the first contact along a motion. A search of both trees lists the pairs of triangles that
/// may meet on a part of the way. Then the pair that may meet first goes on by conservative
/// advancement: an axis parts the triangles until they have gone the gap along it. Within the
/// tolerance of a contact, exact tests decide. The search passes through nothing, however thin or
/// fast. If no axis parts two triangles by more than rounding, and no exact test finds that they
/// meet, the pair goes on by the tolerance at once, and `grazed` is set.
///
/// @param query     of two trees with triangles
/// @param motion    of the moving body, fixed coordinates
/// @param tolerance mesh units: how far a point of the moving body may go from `lower` to `upper`
/// @param options   limits of the search
///
/// `query` forgets its earlier questions. An answer has the same bits on every instruction set.
/// Cost: 0.4 to 1 ms for jaws that close, up to 4 ms if many triangles stay near each other: 3 to 8
/// lists of 50 to 300 µs, 1 µs a pair that is measured, and the verdicts. Along triangles within
/// rounding of each other, four verdicts for a way as long as the tolerance. Memory is allocated.
/// Throws kTrianglesMissing, and
/// kArgumentInvalid for a tolerance that is negative or NaN. Source: B. Mirtich, Impulse-based
/// dynamic simulation of rigid body systems, dissertation, University of California at Berkeley,
/// 1996; for the axes X. Zhang, M. Lee, Y. J. Kim, Interactive continuous collision detection for
/// non-convex polyhedra, The Visual Computer 22, 2006.
[[nodiscard]] IST_API FirstContact first_contact(Query& query, const Motion& motion,
                                                 double tolerance,
                                                 const FirstContactOptions& options = {});

/// Along Motion::between(from, to). Throws kPoseInvalid too.
[[nodiscard]] IST_API FirstContact first_contact(Query& query, const Eigen::Isometry3d& from,
                                                 const Eigen::Isometry3d& to, double tolerance,
                                                 const FirstContactOptions& options = {});

}  // namespace ist
