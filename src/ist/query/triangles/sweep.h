#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ist/base/float_rounding.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "simd/triangles/cluster_step.h"

namespace ist {

/// A part of a screw motion, in fixed mesh coordinates and units of the motion's parameter. A point
/// that is at y has the velocity turning × y + drift.
struct ScrewPart {
  Eigen::Isometry3d middle;        ///< the pose in the middle of the part: rigid
  Eigen::Vector3d turning, drift;  ///< angular velocity, and velocity at the origin
  double half;                     ///< half of the part's length
  double speed;                    ///< the most of any point of the moving body
  double pad;                      ///< rounding of a coordinate at any pose of the part

  /// Returns the velocity of a point.
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::Vector3d& at) const noexcept;
  /// Returns half of the most acceleration of a point that is no faster than `fastest`.
  [[nodiscard]] double bend(double fastest) const noexcept;
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

  /// Returns the time after the middle of the part before which what is in a lane does not meet
  /// what is in a fixed node. `lanes` are widened. Cost: 30 ns.
  [[nodiscard]] double meets_after(const TurnedBlock& lanes, std::size_t lane,
                                   const NodeBlock& fixed, std::size_t node) const noexcept;

 private:
  // The velocity of a point in the clusters' frame.
  struct Velocity {
    double of[3];
  };
  [[nodiscard]] Velocity velocity(const double (&at)[3]) const noexcept;

  double turning_[3][3], drift_[3];  // the velocity field in the clusters' frame
  double half_, turn_, bend_, pad_;
};

/// Two clusters that may meet on a part of a motion, by their indices.
struct SweptPair {
  double after;  ///< the middle of the part: they do not meet before
  std::uint32_t fixed, moving;
};

/// Lists all pairs of clusters that may meet on a part of a motion: a visitor of a ClusterSearch
/// with a sweep.
class SweptPairs {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;

  /// @param step of the search
  /// @param pad  rounding of a coordinate, mesh units
  /// @param most more pairs end the search; `out` has room for one more
  SweptPairs(const ClusterStep& step, const Sweep& sweep, double pad, std::size_t most,
             std::vector<SweptPair>& out) noexcept
      : step_(step), sweep_(sweep), pad_(pad), most_(most), out_(out) {}

  [[nodiscard]] float reach() const noexcept { return rounded_up(pad_ + double{step_.pose.error}); }
  bool visit(const ClusterPairs& clusters) noexcept {
    const LaneNodes& pairs = clusters.pairs;
    for (std::size_t k = 0; k < pairs.count && out_.size() <= most_; ++k) {
      const std::uint32_t lane = pairs.lane(k), node = pairs.node(k);
      const NodeBlock& block = step_.fixed_nodes.blocks[node / kClusterWidth];
      out_.push_back({sweep_.meets_after(clusters.lanes, lane, block, node % kClusterWidth), node,
                      clusters.moving + lane});
    }
    return out_.size() <= most_;
  }

 private:
  const ClusterStep& step_;
  const Sweep& sweep_;
  double pad_;
  std::size_t most_;
  std::vector<SweptPair>& out_;
};

}  // namespace ist
