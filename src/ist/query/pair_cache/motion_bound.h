#pragma once

#include <Eigen/Core>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Bounds how far the leaves of two bodies come nearer each other by a motion.
class MotionBound {
 public:
  /// The box in a tree's frame that holds the centres of its leaves.
  struct Box {
    Eigen::Vector3d centre, half;
  };
  /// Cost: 1 ns a node above the leaves.
  [[nodiscard]] static Box box_of(const SphereTree& tree);

  MotionBound(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy)
      : MotionBound(fixed, box_of(fixed), moving, box_of(moving), policy) {}
  MotionBound(const SphereTree& fixed, const Box& of_fixed, const SphereTree& moving,
              const Box& of_moving, SpherePolicy policy) noexcept;

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
  Box fixed_, moving_;
  double leaves_;   // the radii of the largest leaves, added
  double lengths_;  // the bounding radii, added
};

}  // namespace ist
