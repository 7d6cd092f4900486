#include "ist/tree/sphere_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ist/base/assert.h"
#include "ist/base/error.h"

namespace ist {
namespace {

// In half edges of the root, rounded up. A ball of the table reaches at most (√12 + √96)/6 half
// edges from its node's centre, for three children of which no two share a face; a node's own
// centre is at most √3 half edges of the root from the root's, less √3 of its own. So the root's
// ball reaches farthest.
constexpr double kImplicitReach = 2.21034343104508;

// Whether there are none, or a block for each parent of each level.
template <typename Block>
[[maybe_unused]] bool fit(const std::vector<std::vector<Block>>& blocks,
                          const LinearOctree& octree) {
  bool fit = blocks.empty() || blocks.size() == static_cast<std::size_t>(octree.depth()) + 1;
  for (std::size_t level = 0; fit && level < blocks.size(); ++level) {
    fit = blocks[level].size() + 1 == octree.nodes(static_cast<int>(level) + 1).size();
  }
  return fit;
}

}  // namespace

SphereTree::SphereTree(Parts parts) : parts_(std::move(parts)) {
  IST_ASSERT(parts_.octree.depth() == parts_.lattice.depth);
  IST_ASSERT(parts_.normals.size() == parts_.octree.leaf_count());
  IST_ASSERT(fit(parts_.bounds.balls, parts_.octree) && fit(parts_.bounds.slabs, parts_.octree));
  IST_ASSERT(parts_.bounds.slabs.empty() || !parts_.bounds.balls.empty());
  IST_ASSERT(!parts_.triangles || parts_.triangles->lists.size() == parts_.octree.leaf_count());
  reach_ = kImplicitReach * 0.5 * parts_.lattice.edge(parts_.lattice.depth);
  if (!has(SpherePolicy::kTight)) return;
  for (int level = 0; level <= depth(); ++level) {
    double largest = 0, farthest2 = 0;
    for (std::uint32_t parent = 0; parent < balls(level).size(); ++parent) {
      for (int slot = 0; slot < parts_.octree.child_count(level + 1, parent); ++slot) {
        const Ball ball = saved_ball(level, parent, slot);
        largest = std::max(largest, ball.radius);
        farthest2 = std::max(farthest2, ball.centre.squaredNorm());
      }
    }
    if (level == 0) largest_saved_leaf_ = largest;
    // Largest radius and farthest centre of a level: no less than the true reach, and cheap.
    reach_ = std::max(reach_, (std::sqrt(farthest2) + largest) * (1 + 0x1p-50));
  }
}

void SphereTree::require(SpherePolicy policy, std::string_view body) const {
  if (has(policy)) return;
  throw Error(
      ErrorCode::kPolicyMissing,
      fmt::format("{}: the tree holds no {} spheres: build it with --spheres {}, or ask for "
                  "simple or table",
                  body, to_string(policy), to_string(policy)));
}

double SphereTree::largest_leaf_radius(SpherePolicy policy) const noexcept {
  return is_implicit(policy) ? 0.5 * parts_.lattice.voxel_size * kSqrt3 : largest_saved_leaf_;
}

std::uint64_t SphereTree::bytes() const noexcept {
  const auto size = [](const auto& vector) { return vector.capacity() * sizeof(*vector.data()); };
  std::uint64_t bytes = sizeof(*this) + parts_.octree.bytes() + size(parts_.normals);
  for (const auto& level : parts_.bounds.balls) bytes += size(level);
  for (const auto& level : parts_.bounds.slabs) bytes += size(level);
  if (parts_.triangles) {
    bytes += size(parts_.triangles->mesh.vertices) + size(parts_.triangles->mesh.triangles) +
             size(parts_.triangles->lists.first) + size(parts_.triangles->lists.ids);
  }
  if (parts_.proximity) bytes += parts_.proximity->octree.bytes();
  return bytes;
}

}  // namespace ist
