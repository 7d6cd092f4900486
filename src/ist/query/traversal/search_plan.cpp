#include "ist/query/traversal/search_plan.h"

#include <algorithm>
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

// Returns the least float that is no less.
float least_float(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest < value ? std::nextafter(nearest, HUGE_VALF) : nearest;
}

ImplicitLevel implicit_level(const TreeVoxels& tree, SpherePolicy policy, int level) noexcept {
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

// Makes all levels of a tree, the leaves first; none if the policy has blocks.
void make_implicit_levels(const TreeVoxels& tree, SpherePolicy policy,
                          std::vector<ImplicitLevel>& levels) noexcept {
  levels.clear();
  for (int level = 0; is_implicit(policy) && level <= tree.lattice.depth; ++level) {
    levels.push_back(implicit_level(tree, policy, level));
  }
}

// Makes the view of the children at `level` that a step reads.
SearchSide read_children(const SphereTree& tree, SpherePolicy policy, int level,
                         const std::vector<ImplicitLevel>& levels) noexcept {
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

// Calls visit(a, b, open_a, open_b, size) for each step, which goes down to the fixed level `a` and
// the moving level `b`.
template <class Visit>
void walk(const TreeShape& fixed, const TreeShape& moving, SearchLevels last, Visit visit) {
  int a = fixed.depth, b = moving.depth;
  bool begun = false;  // two leaves alone take a step
  while (a > last.fixed || b > last.moving || !begun) {
    begun = true;
    const int left_a = a - last.fixed, left_b = b - last.moving;
    const bool open_a = descends(left_a, fixed.edge(a), left_b, moving.edge(b)),
               open_b = descends(left_b, moving.edge(b), left_a, fixed.edge(a));
    const auto nodes = [](const TreeShape& tree, int level) -> std::size_t {
      return tree.nodes[static_cast<std::size_t>(level)];
    };
    const std::size_t before = nodes(fixed, a) * nodes(moving, b);
    a -= open_a ? 1 : 0;
    b -= open_b ? 1 : 0;
    visit(a, b, open_a, open_b,
          SearchPlan::Size{nodes(moving, b), before * (open_a ? 8 : 1) * (open_b ? 8 : 1)});
  }
}

}  // namespace

TreeShape::TreeShape(const SphereTree& tree) noexcept
    : voxel_size(tree.voxel_size()), depth(tree.depth()) {
  IST_ASSERT(static_cast<std::size_t>(depth) < kMostLevels);
  for (int level = 0; level <= depth; ++level) {
    nodes[static_cast<std::size_t>(level)] = voxels_of(tree).octree.node_count(level);
  }
}

void TreeShape::include(const TreeShape& other) noexcept {
  for (std::size_t k = 0; k < kMostLevels; ++k) nodes[k] = std::max(nodes[k], other.nodes[k]);
}

SearchPlan::Sizes SearchPlan::sizes_of(const TreeShape& fixed, const TreeShape& moving) noexcept {
  Sizes sizes;
  walk(fixed, moving, {},
       [&](int, int, bool, bool, const Size& size) { sizes.steps[sizes.count++] = size; });
  return sizes;
}

void SearchPlan::require_addresses(const SphereTree& tree, std::string_view body) {
  if (tree.depth() == 0 || voxels_of(tree).octree.node_count(1) < kMostParents) return;
  throw_error(ErrorCode::kMemoryLimit,
              "{}: a tree of {} leaves is too large to be searched: use larger voxels", body,
              tree.leaf_count());
}

SearchPlan::SearchPlan(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                       SearchLevels last) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
  require_addresses(fixed, "fixed");
  require_addresses(moving, "moving");
  fixed_implicit_.reserve(TreeShape::kMostLevels);
  moving_implicit_.reserve(TreeShape::kMostLevels);
  steps_.reserve(kMostSteps);
  make(fixed, TreeShape(fixed), moving, TreeShape(moving), policy, last);
}

void SearchPlan::make(const SphereTree& fixed, const TreeShape& of_fixed, const SphereTree& moving,
                      const TreeShape& of_moving, SpherePolicy policy, SearchLevels last) noexcept {
  make_implicit_levels(voxels_of(fixed), policy, fixed_implicit_);
  make_implicit_levels(voxels_of(moving), policy, moving_implicit_);
  steps_.clear();
  sizes_.count = 0;
  walk(of_fixed, of_moving, last, [&](int a, int b, bool open_a, bool open_b, const Size& size) {
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
    step.radius_limit = static_cast<float>(2 * (of_fixed.edge(a) + of_moving.edge(b)));
    IST_ASSERT(steps_.size() < kMostSteps);
    steps_.push_back(step);
    sizes_.steps[sizes_.count++] = size;
  });
  fixed_leaves_ = steps_.back().fixed.descends ? nullptr : steps_.back().fixed.nodes;
  moving_leaves_ = steps_.back().moving.descends ? nullptr : steps_.back().moving.nodes;
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
