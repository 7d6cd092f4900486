#include "ist/query/world/pair_asker.h"

#include <algorithm>

#include "ist/base/access.h"
#include "ist/base/ordered_vector.h"
#include "ist/tree/tree_parts.h"

namespace ist::detail {
namespace {

// A pair cache pays for motions of up to some 0.1 voxel. This is an upper bound of the motion.
constexpr double kSlow = 0.5;

// The caches belong to the pairs.
QueryOptions without_cache(const WorldOptions& options) {
  QueryOptions query = options.query;
  query.front_pairs = query.near_pairs = 0;
  return query;
}

SpherePolicy policy_of_any(const AskerRoom& room, const WorldOptions& options) noexcept {
  return QueryState::policy_of(*room.query.voxels, *room.query.voxels, options.query);
}

// Returns whether no point of the moving body moved by more than a part of a voxel.
bool is_slow(const BodyPose& from, const BodyPose& to, const SphereTree& fixed,
             const SphereTree& moving) noexcept {
  const auto centre = [&](const BodyPose& pose) {
    return moved(RelativePose{pose.rotation, pose.translation}, moving.origin());
  };
  const double shift = length_in_order(difference(centre(to), centre(from)));
  const double turn = 3 * (to.rotation - from.rotation).cwiseAbs().maxCoeff();
  return shift + turn * moving.bounding_radius() <=
         kSlow * std::min(fixed.voxel_size(), moving.voxel_size());
}

}  // namespace

AskerRoom AskerRoom::of(std::span<const AskedBody> bodies, const WorldOptions& options) {
  AskerRoom room;
  std::vector<TreeShape> shapes;  // of each depth and voxel size, with the most nodes of any
  std::size_t with_voxels = 0;
  int root_level = 0;  // of the clusters
  for (const AskedBody& body : bodies) {
    if (room.any == nullptr || !body.facts.leaves) room.any = &body.tree;
    if (const auto& triangles = parts_of(body.tree).triangles) {
      room.query.triangles = &body.tree;
      root_level = std::max(root_level, triangles->clusters.root_level());
    }
    if (!body.facts.leaves) continue;
    if (++with_voxels > 1) room.query.voxels = &body.tree;
    const TreeShape& shape = body.facts.leaves->shape;
    const auto like = std::find_if(shapes.begin(), shapes.end(),
                                   [&](const TreeShape& other) { return other.is_like(shape); });
    if (like == shapes.end()) {
      shapes.push_back(shape);
    } else {
      like->include(shape);
    }
    room.leaves = std::max(room.leaves, ContactReducer::most_leaves(body.tree, options.manifold));
  }
  for (const TreeShape& fixed : shapes) {
    for (const TreeShape& moving : shapes) {
      room.query.search_items = std::max(
          room.query.search_items,
          Search::items_for(SearchPlan::sizes_of(fixed, moving), options.query.frontier_pairs));
    }
  }
  for (const AskedBody& body : bodies) {
    const auto& triangles = parts_of(body.tree).triangles;
    if (!triangles) continue;
    room.query.cluster_items = std::max(room.query.cluster_items,
                                        ClusterSearch::items_for(triangles->clusters, root_level));
  }
  return room;
}

CacheSlot::CacheSlot(const AskerRoom& room, const WorldOptions& options)
    : plan(*room.query.voxels, *room.query.voxels, policy_of_any(room, options)),
      cached(*room.query.voxels, *room.query.voxels, policy_of_any(room, options), plan,
             select_kernels(options.query.target), cache_options(options.query),
             room.query.search_items) {}

std::uint64_t CacheSlot::bytes_for(const AskerRoom& room, const WorldOptions& options) {
  const SearchPlan plan(*room.query.voxels, *room.query.voxels, policy_of_any(room, options));
  return CachedSearch::bytes_for(plan, cache_options(options.query), room.query.search_items);
}

void CacheSlot::bind(BodyPair pair, const AskedBody& a, const AskedBody& b,
                     SpherePolicy policy) noexcept {
  bodies = pair;
  plan.bind(a.tree, a.facts.leaves->shape, b.tree, b.facts.leaves->shape, policy);
  cached.bind(a.tree, b.tree, policy,
              MotionBound(a.tree, a.facts.leaves->box, b.tree, b.facts.leaves->box, policy));
}

CacheSlots::CacheSlots(std::size_t count, const AskerRoom& room, const WorldOptions& options) {
  slots_.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    slots_.push_back(std::make_unique<CacheSlot>(room, options));
  }
}

void CacheSlots::note(PairMemory& memory, const BodyPose& pose, const AskedBody& a,
                      const AskedBody& b, SpherePolicy policy) noexcept {
  const bool in_turn = memory.leaf_tick > 0 && memory.leaf_tick + 1 == leaf_tick_;
  if (!owns(memory) && in_turn && is_slow(memory.pose, pose, a.tree, b.tree)) {
    // Pairs that were not asked in the question before lose their slot.
    while (next_ < slots_.size() && slots_[next_]->leaf_tick > 0 &&
           slots_[next_]->leaf_tick + 1 >= leaf_tick_) {
      ++next_;
    }
    if (next_ < slots_.size()) {
      memory.slot = static_cast<std::uint32_t>(next_);
      slots_[next_++]->bind(memory.bodies, a, b, policy);
      slots_[memory.slot]->leaf_tick = leaf_tick_;
    }
  }
  if (owns(memory)) slots_[memory.slot]->leaf_tick = leaf_tick_;
  memory.leaf_tick = leaf_tick_;
  memory.pose = pose;
}

void CacheSlots::forget() noexcept {
  for (const auto& slot : slots_) slot->leaf_tick = 0;
}

PairAsker::PairAsker(const AskerRoom& room, const WorldOptions& options)
    : work_(room.has_leaves() ? std::make_unique<ContactWork>(options.manifold, room.leaves)
                              : nullptr),
      query_(Access::made_of<Query>(std::make_unique<QueryState>(
          *room.any, *room.any, without_cache(options), ScopedFloatEnvironment(), room.query))),
      state_(&Access::state(query_)) {}

std::uint64_t PairAsker::bytes_for(const AskerRoom& room, const WorldOptions& options) {
  const std::size_t bytes =
      QueryState::bytes_for(*room.any, *room.any, without_cache(options), room.query);
  if (!room.has_leaves()) return bytes;
  return bytes + ContactReducer::bytes_of_work(options.manifold, room.leaves);
}

Query& PairAsker::bind(const AskedBody& a, const AskedBody& b, const PairMemory& memory,
                       bool of_leaves, CachedSearch* cached) noexcept {
  state_->bind(a.tree, a.facts, b.tree, b.facts, of_leaves);
  state_->cached = cached;
  if (state_->triangles != nullptr) state_->triangles->witnesses() = memory.witnesses;
  return query_;
}

}  // namespace ist::detail
