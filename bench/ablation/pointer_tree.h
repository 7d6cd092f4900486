#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "ist/tree/linear_octree.h"

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

}  // namespace ist::bench
