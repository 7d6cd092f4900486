#include "ist/tree/bound_builder.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/node_bounds.h"

namespace ist {

BoundBuilder::BoundBuilder(SpherePolicy policy) : policy_(policy) {
  IST_ASSERT(!is_implicit(policy));
}

void BoundBuilder::begin(const Lattice& lattice, std::size_t parents) {
  lattice_ = lattice;
  balls_.resize(parents);
  if (policy_ == SpherePolicy::kSlab) slabs_.resize(parents);
}

void BoundBuilder::visit(std::size_t parent, int slot, const Cell& cell, const Payload& payload) {
  // The centre of the cube of two cells an axis. The root's parent has the root's centre.
  const auto middle = [&](std::size_t i) { return lattice_.depth == 0 ? 0.5 : cell[i] | 1u; };
  const Eigen::Vector3d parent_centre(middle(0), middle(1), middle(2));
  const PackedBall ball = pack_ball(payload, parent_centre, 2);
  balls_[parent].set(slot, ball);
  if (slabs_.empty()) return;
  slabs_[parent].set(slot, pack_slab(payload, centre_of(ball, parent_centre, 2), 1));
}

BoundBlocks BoundBuilder::finish(const LinearOctree& octree, Progress* progress) {
  const ScopedFloatEnvironment environment;
  IST_ASSERT(balls_.size() + 1 == octree.nodes(1).size());
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  shown.begin_stage("fitting bounds", octree.node_count() - octree.leaf_count());
  const auto levels = static_cast<std::size_t>(octree.depth()) + 1;
  BoundBlocks bounds;
  bounds.balls.resize(levels);
  bounds.balls[0] = std::move(balls_);
  if (!slabs_.empty()) {
    bounds.slabs.resize(levels);
    bounds.slabs[0] = std::move(slabs_);
  }
  nest_bounds(octree, 0x1p-48 * (2 * lattice_.root_centre()), bounds, shown);
  return bounds;
}

}  // namespace ist
