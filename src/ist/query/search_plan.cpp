#include "ist/query/search_plan.h"

#include <fmt/format.h>

#include "ist/base/error.h"
#include "ist/query/bound_lanes.h"
#include "ist/query/query_rules.h"

namespace ist {
namespace {

// Of parents, so that an address is 32 bits.
constexpr std::uint32_t kMostParents = 1U << 29;
constexpr std::uint8_t kRootMask = 1;  // of the root's parent

void require_addresses(const SphereTree& tree, const char* body) {
  if (tree.depth() == 0 || tree.octree().node_count(1) < kMostParents) return;
  throw Error(ErrorCode::kMemoryLimit,
              fmt::format("{}: a tree of {} leaves is too large to be searched: use larger voxels",
                          body, tree.octree().leaf_count()));
}

// How a step reads the children at `level`.
SearchSide read_children(const SphereTree& tree, SpherePolicy policy, int level) {
  const LinearOctree& octree = tree.octree();
  const bool is_root = level == tree.depth();
  const double edge = tree.lattice().edge(level);
  SearchSide side{};
  side.nodes = octree.nodes(level + 1).data();
  side.masks = is_root ? &kRootMask : octree.masks(level + 1).data();
  side.voxel_size = static_cast<float>(tree.lattice().voxel_size);
  side.half_edge = static_cast<float>(0.5 * edge);
  if (is_implicit(policy)) {
    side.octant_offset = is_root ? 0 : side.half_edge;
    side.child_masks =
        policy == SpherePolicy::kTable && level > 0 ? octree.masks(level).data() : nullptr;
    return side;
  }
  side.balls = tree.balls(level).data();
  side.ball_unit = static_cast<float>(2 * edge * PackedBall::kUnit);
  if (policy == SpherePolicy::kSlab) {
    side.slabs = tree.slabs(level).data();
    side.slab_unit = static_cast<float>(edge * PackedSlab::kUnit * kSlabScale);
  }
  return side;
}

}  // namespace

SearchPlan::SearchPlan(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                       SearchLevels last) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
  require_addresses(fixed, "fixed");
  require_addresses(moving, "moving");
  int a = fixed.depth(), b = moving.depth();
  while (a > last.fixed || b > last.moving || steps_.empty()) {  // two leaves alone are a step too
    const double edge_a = fixed.lattice().edge(a), edge_b = moving.lattice().edge(b);
    const int left_a = a - last.fixed, left_b = b - last.moving;
    const bool open_a = opens(left_a, edge_a, left_b, edge_b),
               open_b = opens(left_b, edge_b, left_a, edge_a);
    const std::size_t before =
        std::size_t{fixed.octree().node_count(a)} * moving.octree().node_count(b);
    a -= open_a ? 1 : 0;
    b -= open_b ? 1 : 0;
    SearchStep step{read_children(fixed, policy, a), read_children(moving, policy, b)};
    step.fixed.opens = open_a;
    step.moving.opens = open_b;
    step.fixed.names_addresses = a == last.fixed && b > last.moving;
    step.moving.names_addresses = b == last.moving && a > last.fixed;
    steps_.push_back(step);
    sizes_.push_back({moving.octree().node_count(b), before * (open_a ? 8 : 1) * (open_b ? 8 : 1)});
  }
  if (!steps_.back().fixed.opens) fixed_leaves_ = steps_.back().fixed.nodes;
  if (!steps_.back().moving.opens) moving_leaves_ = steps_.back().moving.nodes;
}

void SearchPlan::resolve(std::span<Contact> contacts) const noexcept {
  const auto index = [](const OctreeNode* parents, std::uint32_t address) {
    return parents[address / 8].first_child + address % 8;
  };
  if (fixed_leaves_ != nullptr) {
    for (Contact& contact : contacts) contact.fixed = index(fixed_leaves_, contact.fixed);
  }
  if (moving_leaves_ != nullptr) {
    for (Contact& contact : contacts) contact.moving = index(moving_leaves_, contact.moving);
  }
}

}  // namespace ist
