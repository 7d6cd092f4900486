#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// How deep two bodies are in each other: the largest distance of a point of either surface, where
/// it lies inside the other body, from the other surface. A body wholly inside another counts.
struct Penetration {
  /// Whether there is an answer, or why not.
  enum class Status : std::uint8_t {
    kDone,             ///< the interval holds the depth
    kInvalidPose,      ///< the pose is no rigid motion
    kFixedNotClosed,   ///< the fixed body has no certain inside: SphereTree::orientation()
    kMovingNotClosed,  ///< the moving body has no certain inside
    kBusy,             ///< another thread is using the query
  };

  Status status = Status::kDone;  ///< other than kDone: the interval is [0, infinity]
  bool complete = false;          ///< the interval is no wider than the tolerance, or `narrowest`
  bool capped = false;            ///< the search ended after 4 million pieces of triangles
  double lower = 0,               ///< the depth is no less, mesh units; 0: the bodies may be apart
      upper = std::numeric_limits<double>::infinity();  ///< and no more; 0: they do not intersect
  /// A point of a surface that is `lower` deep, to within rounding; fixed coordinates. Zero where
  /// no point was found inside.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// The direction from there to the other surface's nearest point, of unit length, fixed axes: the
  /// shortest way out. Zero where no point was found inside.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  bool of_moving = false;      ///< whose surface the point lies on
  std::uint32_t triangle = 0;  ///< the one of that surface that holds the point
  /// The width below which no tolerance can be reached here: rounding.
  double narrowest = 0;
  /// Whether the surface of a body intersects itself: SphereTree::self_intersections(). Inside is
  /// certain all the same. The depth is the distance from the nearest triangle, which may lie
  /// inside the body.
  bool fixed_self_intersecting = false,  ///< the fixed body's surface
      moving_self_intersecting = false;  ///< the moving body's
  std::uint64_t points = 0;              ///< points of which the distance was measured
  /// How far the rotation of the given pose was from orthonormal (rotation_error).
  double rotation_error = 0;
};
/// Returns the status' name, such as "fixed-not-closed", for logs and tests.
[[nodiscard]] IST_API const char* to_string(Penetration::Status status) noexcept;

/// The options of penetration().
struct PenetrationOptions {
  /// An earlier answer of the same bodies, for a search that begins where its point is now. The
  /// interval is true whatever this says.
  const Penetration* last = nullptr;
  Budget budget = {};    ///< `tests` counts points; the interval is wider where it ends the search
  Proceed proceed = {};  ///< asked every 1,024 points; the interval is wider where it ends it
};

/// Bounds the depth of two bodies by an interval no wider than `tolerance`, or `narrowest`: by
/// branch and bound over the clusters of both surfaces. Both bodies must be closed. A point is
/// inside a body if its winding number is not 0.
///
/// The bound of a node is its centre's signed distance and its radius; of a piece of a triangle,
/// also the distance of its corners from the triangle that is nearest to its middle: a distance
/// from one triangle is a convex function. Allocates. Cost: 5 to 10 ms for jaws in occlusion to
/// 0.01 mm, hardly less from the last answer; the first time for a tree, 1.2 µs a triangle more.
/// Without a budget the search ends in one of two ways. Either the interval is complete, or the
/// search kept 4 million pieces of triangles (2^22): then `capped` is true. Surfaces that lie on
/// each other may need so many, and points whose side is unknown. The answer depends on the bodies,
/// the pose, the tolerance and `last`, and on no earlier question.
/// Throws kTrianglesMissing, and kArgumentInvalid for a tolerance that is negative or NaN.
[[nodiscard]] IST_API Penetration penetration(Query& query, const Eigen::Isometry3d& pose,
                                              double tolerance,
                                              const PenetrationOptions& options = {});

}  // namespace ist
