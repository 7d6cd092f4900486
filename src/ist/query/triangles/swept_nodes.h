#pragma once

#include <Eigen/Geometry>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/relative_pose.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

/// A part of a screw motion, in fixed mesh coordinates and units of the motion's parameter. A point
/// that is at y has the velocity turning × y + drift.
struct ScrewPart {
  RelativePose start, middle;      ///< the poses at the begin and in the middle of the part: rigid
  Eigen::Vector3d turning, drift;  ///< angular velocity, and velocity at the origin
  double half;                     ///< half of the part's length
  double speed;                    ///< the most of any point of the moving body
  double pad;                      ///< rounding of a coordinate at any pose of the part

  /// Returns the velocity of a point.
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::Vector3d& at) const noexcept;
  /// Returns the most by which a point leaves its straight way before the end of the part, if no
  /// point is faster than `fastest`: half of its acceleration times the square of the time.
  [[nodiscard]] double bend(double fastest) const noexcept;
};

/// Two triangles that may meet on a part of a motion.
struct SweptPair {
  double after;  ///< the begin of the part: they do not meet before
  TriangleIds ids;
};

/// The space through which nodes of a moving body go on a part of a motion: their bounds at the
/// pose in its middle, widened along their velocities.
class Sweep {
 public:
  /// @param fixed the clusters of the fixed body, in whose frame the nodes are turned
  Sweep(const ScrewPart& part, const TriangleClusters& fixed) noexcept;

  /// Widens the bounds of all lanes. They hold what is in the nodes at every pose of the part.
  /// Cost: 0.2 µs.
  void widen(TurnedBlock& lanes) const noexcept;

 private:
  double turning_[3][3], drift_[3];  // the velocity field in the clusters' frame
  double half_, turn_, bend_;
};

}  // namespace ist
