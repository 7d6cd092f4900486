#include "ist/query/traversal/search_plan.h"

#include <cmath>

#include "ist/base/assert.h"
#include "ist/base/throw_error.h"
#include "ist/query/query_rules.h"
#include "ist/tree/tree_parts.h"
#include "simd/lanes.h"

namespace ist {
namespace {

// The most parents of a level, so that 8 · parent + slot fits 32 bits.
constexpr std::uint32_t kMostParents = 1U << 29;
constexpr std::uint8_t kRootMask = 1;  // the root's parent has one child

void require_addresses(const SphereTree& tree, const char* body) {
  if (tree.depth() == 0 || voxels_of(tree).octree.node_count(1) < kMostParents) return;
  throw_error(ErrorCode::kMemoryLimit,
              "{}: a tree of {} leaves is too large to be searched: use larger voxels", body,
              tree.leaf_count());
}

// Returns the least float that is no less.
float least_float(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest < value ? std::nextafter(nearest, HUGE_VALF) : nearest;
}

ImplicitLevel implicit_level(const TreeVoxels& tree, SpherePolicy policy, int level) {
  const double half = 0.5 * tree.lattice.edge(level);
  ImplicitLevel made{};
  for (int code = 0; code < 8; ++code) {
    const double length = half / 6 * (code & 3);
    made.offset[code] = static_cast<float>((code & 4) != 0 ? -length : length);
  }
  for (std::size_t code = 0; code < kTableRadii.size(); ++code) {
    made.radius[code] = least_float(nested_radius(tree.lattice, level, code));
  }
  const bool looks_up = policy == SpherePolicy::kTable && level > 0;
  made.masks = looks_up ? tree.octree.masks(level).data() : nullptr;
  return made;
}

// Makes all levels of a tree, the leaves first; none where the policy has blocks. Throws
// kPolicyMissing, naming `body`.
std::vector<ImplicitLevel> implicit_levels(const SphereTree& of, SpherePolicy policy,
                                           const char* body) {
  of.require(policy, body);
  const TreeVoxels& tree = voxels_of(of);
  std::vector<ImplicitLevel> levels;
  for (int level = 0; is_implicit(policy) && level <= tree.lattice.depth; ++level) {
    levels.push_back(implicit_level(tree, policy, level));
  }
  return levels;
}

// Makes the view of the children at `level` that a step reads.
SearchSide read_children(const SphereTree& tree, SpherePolicy policy, int level,
                         const std::vector<ImplicitLevel>& levels) {
  const LinearOctree& octree = voxels_of(tree).octree;
  const bool is_root = level == tree.depth();
  const double edge = voxels_of(tree).lattice.edge(level);
  SearchSide side{};
  side.nodes = octree.nodes(level + 1).data();
  side.masks = is_root ? &kRootMask : octree.masks(level + 1).data();
  side.voxel_size = static_cast<float>(tree.voxel_size());
  if (is_implicit(policy)) {
    side.implicit = &levels[static_cast<std::size_t>(level)];
    side.octant_offset = is_root ? 0 : static_cast<float>(0.5 * edge);
    return side;
  }
  side.balls = voxels_of(tree).balls(level).data();
  side.ball_unit = static_cast<float>(2 * edge * PackedBall::kUnit);
  if (policy == SpherePolicy::kSlab) {
    side.slabs = voxels_of(tree).slabs(level).data();
    side.slab_unit = static_cast<float>(edge * PackedSlab::kUnit * kSlabScale);
  }
  return side;
}

}  // namespace

SearchPlan::SearchPlan(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                       SearchLevels last)
    : fixed_implicit_(implicit_levels(fixed, policy, "fixed")),
      moving_implicit_(implicit_levels(moving, policy, "moving")) {
  require_addresses(fixed, "fixed");
  require_addresses(moving, "moving");
  int a = fixed.depth(), b = moving.depth();
  while (a > last.fixed || b > last.moving || steps_.empty()) {  // two leaves alone take a step
    const double edge_a = voxels_of(fixed).lattice.edge(a),
                 edge_b = voxels_of(moving).lattice.edge(b);
    const int left_a = a - last.fixed, left_b = b - last.moving;
    const bool open_a = descends(left_a, edge_a, left_b, edge_b),
               open_b = descends(left_b, edge_b, left_a, edge_a);
    const std::size_t before =
        std::size_t{voxels_of(fixed).octree.node_count(a)} * voxels_of(moving).octree.node_count(b);
    a -= open_a ? 1 : 0;
    b -= open_b ? 1 : 0;
    SearchStep step{read_children(fixed, policy, a, fixed_implicit_),
                    read_children(moving, policy, b, moving_implicit_),
                    false,
                    a == 0 && b == 0,
                    0,
                    voxels_of(fixed).normals.data(),
                    voxels_of(moving).normals.data()};
    step.fixed.descends = open_a;
    step.moving.descends = open_b;
    step.fixed.emits_slots = a == last.fixed && b > last.moving;
    step.moving.emits_slots = b == last.moving && a > last.fixed;
    step.last = a <= last.fixed && b <= last.moving;
    step.radius_limit = static_cast<float>(
        2 * (voxels_of(fixed).lattice.edge(a) + voxels_of(moving).lattice.edge(b)));
    steps_.push_back(step);
    sizes_.push_back(
        {voxels_of(moving).octree.node_count(b), before * (open_a ? 8 : 1) * (open_b ? 8 : 1)});
  }
  IST_ASSERT(steps_.size() <= kMostSteps);
  if (!steps_.back().fixed.descends) fixed_leaves_ = steps_.back().fixed.nodes;
  if (!steps_.back().moving.descends) moving_leaves_ = steps_.back().moving.nodes;
}

void SearchPlan::resolve(std::span<LeafPair> leaf_pairs) const noexcept {
  const auto index = [](const OctreeNode* parents, std::uint32_t address) {
    return parents[address / 8].first_child + address % 8;
  };
  if (fixed_leaves_ != nullptr) {
    for (LeafPair& pair : leaf_pairs) pair.fixed = index(fixed_leaves_, pair.fixed);
  }
  if (moving_leaves_ != nullptr) {
    for (LeafPair& pair : leaf_pairs) pair.moving = index(moving_leaves_, pair.moving);
  }
}

}  // namespace ist
