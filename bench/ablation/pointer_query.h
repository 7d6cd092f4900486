#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ist/query/relative_pose.h"
#include "ist/query/results.h"
#include "ist/tree/linear_octree.h"
#include "ist/tree/sphere_tree.h"

namespace ist::bench {

/// A cube of an octree as it was before it was flattened: it owns its children by eight pointers,
/// of which those to empty space are null.
struct PointerNode {
  std::array<std::unique_ptr<PointerNode>, 8> children;
  Eigen::Vector3d cube_centre;  ///< in voxel edges from the root cube's centre: exact
  int level;                    ///< 0 for a leaf
  std::uint32_t index;          ///< of the same node in the linear octree
  std::uint8_t mask;            ///< bit k says that child k is there
};

/// The octree of a body as published: nodes that are allocated one by one and linked by pointers.
///
/// They are allocated depth first, each before its children, as a recursive build makes them, on a
/// heap of which little was freed before. So nodes lie in memory in nearly the order in which a
/// depth-first search visits them: a heap that has been used for long does no better.
class PointerTree {
 public:
  /// Cost: 0.1 to 0.2 µs a node.
  explicit PointerTree(const LinearOctree& octree);

  [[nodiscard]] const PointerNode& root() const noexcept { return *root_; }
  /// Bytes of its nodes, leaves included, without what the heap adds to each.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return nodes_ * sizeof(PointerNode); }

 private:
  [[nodiscard]] std::unique_ptr<PointerNode> make(const LinearOctree& octree, int level,
                                                  std::uint32_t index,
                                                  const Eigen::Vector3d& cube_centre);

  std::uint64_t nodes_ = 0;
  std::unique_ptr<PointerNode> root_;
};

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
