#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ablation/pointer_tree.h"
#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist::bench {

/// The published query on the published layout: ReferenceQuery with kOnTheFly, line by line, except
/// that it goes from node to node by pointers. It makes the same tests and gives the same contacts
/// in the same order. The sphere of a node follows from its own cube, with kTable by a look-up of
/// its mask; kTight and kSlab, which are not published, are read from the linear tree's blocks.
///
/// Holds references to the trees, which must outlive it. One query object belongs to one thread.
class PointerQuery {
 public:
  /// A body: its tree, and the same octree by pointers.
  struct Body {
    const SphereTree& tree;
    const PointerTree& pointers;
  };

  /// Precondition: both trees have `policy`.
  PointerQuery(const Body& fixed, const Body& moving, SpherePolicy policy)
      : fixed_(fixed), moving_(moving), policy_(policy) {}

  /// As ReferenceQuery::leaf_pairs.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out);

 private:
  template <bool kSlabs>
  QueryResult search(const RelativePose& pose, std::span<LeafPair> out);

  Body fixed_, moving_;
  SpherePolicy policy_;
  std::vector<LeafPair> found_;
};

}  // namespace ist::bench
