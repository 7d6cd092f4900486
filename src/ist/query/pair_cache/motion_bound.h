#pragma once

#include <Eigen/Core>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Bounds how far the leaves of two bodies come nearer each other by a motion.
class MotionBound {
 public:
  /// Cost: 1 ns a node above the leaves.
  MotionBound(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy);

  /// Returns a length, mesh units: the separation of two leaves, by their balls or by a slab,
  /// differs by no more than it between the two poses, if their bounds are no farther than `reach`
  /// apart at `to`. The same holds for the distance of two points of the surfaces that are no
  /// farther apart then.
  ///
  /// It is the largest displacement in the box in which such leaves of both bodies can lie
  /// (docs/guarantees.md, The pair cache). Cost: 60 ns.
  [[nodiscard]] double between(const RelativePose& from, const RelativePose& to,
                               double reach) const noexcept;

 private:
  struct Box {
    Eigen::Vector3d centre, half;
  };
  [[nodiscard]] static Box box_of(const SphereTree& tree);

  Box fixed_, moving_;  // which hold the leaves' centres, in the trees' frames
  double leaves_;       // the radii of the largest leaves, added
  double lengths_;      // the bounding radii, added
};

}  // namespace ist
