#pragma once

#include <Eigen/Core>

#include "ist/mesh/triangles_meet.h"
#include "ist/query/triangles/swept_nodes.h"

namespace ist {

/// A fixed triangle, and a moving one at a pose of a screw motion. Lengths are in mesh units, times
/// are units of the motion's parameter. A triangle may be a segment or a point.
class MovingPair {
 public:
  /// @param part of the motion; its pose does not matter
  MovingPair(const TriangleCorners& fixed, const TriangleCorners& moving,
             const ScrewPart& part) noexcept;

  /// The time for which the triangles certainly do not meet, and the axis that parts them so long.
  struct Free {
    double time = 0;                   ///< 0 if no axis parts them by more than rounding
    Eigen::Vector3d axis = {0, 0, 0};  ///< from the fixed to the moving triangle; of any length
  };
  /// Returns the longest free time that some axes give. An axis parts the triangles until the
  /// corners have gone the gap along it, by their velocities and by the most that these change.
  ///
  /// @param enough no longer time is looked for
  ///
  /// Cost: 0.1 to 1 µs. Source: X. Zhang, M. Lee, Y. J. Kim, Interactive continuous collision
  /// detection for non-convex polyhedra, The Visual Computer 22, 2006.
  [[nodiscard]] Free free_time(double enough) const noexcept;

  /// Returns the longest free time that the triangles' normals and the axes of coordinates give.
  /// Cost: 50 to 200 ns.
  [[nodiscard]] double quick_free_time(double enough) const noexcept;

  /// Returns whether the triangles certainly pass through each other until a later pose: a corner
  /// goes to the other side of a face above which it stays, or an edge to the other side of an edge
  /// that it keeps crossing. Then they meet between the poses, whether they meet at any pose in
  /// double or not.
  ///
  /// @param later the same triangles, `time` later
  [[nodiscard]] bool passes_until(const MovingPair& later, double time) const noexcept;

 private:
  [[nodiscard]] double time_along(const Eigen::Vector3d& axis) const noexcept;
  void try_axis(const Eigen::Vector3d& axis, Free& best) const noexcept;

  const TriangleCorners &fixed_, &moving_;
  Eigen::Vector3d velocity_[3];  // of the moving corners
  double bend_[3];               // the most of half of their accelerations
  double turning_, pad_;
};

}  // namespace ist
