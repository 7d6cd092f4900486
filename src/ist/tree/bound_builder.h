#pragma once

#include "ist/base/progress.h"
#include "ist/tree/bound_blocks.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/linear_octree.h"
#include "ist/voxel/payload.h"

namespace ist {

/// Fits the bounds of each leaf while the voxelizer writes the leaves: a bounding sphere of its
/// triangles clipped to its cube grown by the lattice's pad, and, with `slab`, a thin slab round
/// the same geometry. Of a triangle with no part in that cube, the point nearest to the cube's
/// centre counts. So each bound holds a surface point and all geometry of its leaf. The bounds of
/// inner nodes follow from the leaves' (nest_bounds).
///
/// A leaf ball's radius exceeds the smallest of its payload by at most 1 % and the rounding: 3 ·
/// 2⁻¹⁶ of the parent cube's edge, and twice the pad (pack_ball). A slab is no thinner than 2⁻⁸ of
/// its cube's edge.
///
/// Cost: on one core 0.3 µs a leaf with kTight, and 0.7 µs with kSlab, of which inner nodes take a
/// half. The same result for any number of threads.
class BoundBuilder final : public PayloadVisitor {
 public:
  /// @param policy kTight or kSlab
  explicit BoundBuilder(SpherePolicy policy);

  void begin(const Lattice& lattice, std::size_t parents) override;
  void visit(std::size_t parent, int slot, const Cell& cell, const Payload& payload) override;

  /// Fits the bounds of all nodes above the leaves, and returns all bounds. The octree has the
  /// voxels as its leaves.
  [[nodiscard]] BoundBlocks finish(const LinearOctree& octree, Progress* progress = nullptr);

 private:
  SpherePolicy policy_;
  Lattice lattice_;
  std::vector<BallBlock> balls_;  // of the leaves
  std::vector<SlabBlock> slabs_;
};

}  // namespace ist
