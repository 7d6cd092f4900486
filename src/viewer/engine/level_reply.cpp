#include "ist/base/throw_error.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "viewer/engine/replies.h"

namespace ist::viewer {
namespace {

void fill_slabs(const SphereTree& tree, int level, Reply& reply) {
  const TreeVoxels& voxels = voxels_of(tree);
  const std::uint32_t parents = level == tree.depth() ? 1 : voxels.octree.node_count(level + 1);
  std::vector<float> normals, offsets, halves;
  for (std::uint32_t parent = 0; parent < parents; ++parent) {
    for (int slot = 0; slot < voxels.octree.child_count(level + 1, parent); ++slot) {
      const Slab slab = voxels.saved_slab(level, parent, slot);
      for (int axis = 0; axis < 3; ++axis) {
        normals.push_back(static_cast<float>(slab.normal[axis]));
      }
      offsets.push_back(static_cast<float>(slab.offset));
      halves.push_back(static_cast<float>(slab.half));
    }
  }
  reply.json["normals"] = reply.array(std::move(normals));
  reply.json["offsets"] = reply.array(std::move(offsets));
  reply.json["halves"] = reply.array(std::move(halves));
}

}  // namespace

void fill_level(const SphereTree& tree, SpherePolicy policy, int level, Reply& reply) {
  tree.require(policy, "the body");
  if (level < 0 || level > tree.depth()) {
    throw_error(ErrorCode::kArgumentInvalid, "level {}: the tree has levels 0 to {}", level,
                tree.depth());
  }
  std::vector<float> centres, radii;
  for (const Ball& ball : level_spheres(tree, policy, level)) {
    const Eigen::Vector3d centre = tree.origin() + ball.centre;
    for (int axis = 0; axis < 3; ++axis) centres.push_back(static_cast<float>(centre[axis]));
    radii.push_back(static_cast<float>(ball.radius));
  }
  reply.json["centres"] = reply.array(std::move(centres));
  reply.json["radii"] = reply.array(std::move(radii));
  if (policy == SpherePolicy::kSlab) fill_slabs(tree, level, reply);
}

}  // namespace ist::viewer
