#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "ablation/pointer_tree.h"
#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/bounds.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

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

  /// As ReferenceQuery::collide.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out);

 private:
  struct Visit {
    const PointerNode* node;
    Ball ball;  // in the fixed tree's frame
    Slab slab;  // likewise; with kSlab alone
  };
  struct Children {
    int count;
    Visit visits[8];
  };

  // `node` is child `slot` of `parent`, by that one's index in the linear octree.
  [[nodiscard]] Visit visit(const SphereTree& tree, const PointerNode& node, std::uint32_t parent,
                            int slot) const;
  void open(const SphereTree& tree, const PointerNode& node, Children& children) const;
  void to_fixed_frame(Visit& visit) const noexcept;
  [[nodiscard]] bool touch(const Visit& a, const Visit& b) noexcept;
  void descend(const Visit& a, const Visit& b);

  Body fixed_, moving_;
  SpherePolicy policy_;
  RelativePose pose_;
  double slack_ = 0;  // what a test may err by, and a reach is grown by
  std::uint64_t tests_ = 0;
  std::vector<LeafPair> found_;
};

}  // namespace ist::bench
