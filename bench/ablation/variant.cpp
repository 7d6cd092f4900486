#include "ablation/variant.h"

#include <chrono>
#include <memory>
#include <utility>

#include "ablation/pointer_query.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"

namespace ist::bench {
namespace {

using Search = Parts::Search;

std::size_t saved_bytes(const SphereTree& tree, SpherePolicy policy) {
  std::size_t bytes = 0;
  for (int level = 0; level <= tree.depth(); ++level) {
    if (!is_implicit(policy)) bytes += voxels_of(tree).balls(level).size_bytes();
    if (policy == SpherePolicy::kSlab) bytes += voxels_of(tree).slabs(level).size_bytes();
  }
  return bytes;
}

}  // namespace

Variant::Variant(const Bodies& bodies, const Parts& parts)
    : tree_bytes_(saved_bytes(bodies.fixed, parts.policy) +
                  saved_bytes(bodies.moving, parts.policy)) {
  const auto ask_by = [this](auto query) {
    collide_ = [query = std::move(query)](const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
      return query->leaf_pairs(pose, out);
    };
  };
  if (parts.search == Search::kPointers) {
    tree_bytes_ += bodies.fixed_pointers.bytes() + bodies.moving_pointers.bytes();
    bytes_for_a_leaf_pair_ = 2 * sizeof(LeafPair);
    ask_by(std::make_shared<PointerQuery>(PointerQuery::Body{bodies.fixed, bodies.fixed_pointers},
                                          PointerQuery::Body{bodies.moving, bodies.moving_pointers},
                                          parts.policy));
    return;
  }
  tree_bytes_ += voxels_of(bodies.fixed).octree.bytes() + voxels_of(bodies.moving).octree.bytes();
  if (parts.search == Search::kLinear) {
    bytes_for_a_leaf_pair_ = 2 * sizeof(LeafPair);
    ask_by(std::make_shared<ReferenceQuery>(bodies.fixed, bodies.moving, parts.policy));
    return;
  }
  QueryOptions options;
  options.policy = parts.policy;
  options.target = parts.target;
  options.workers = parts.workers;
  options.period = std::chrono::nanoseconds(0);
  auto query = std::make_shared<Query>(bodies.fixed, bodies.moving, options);
  reserved_ = query->bytes();
  ask_by(std::move(query));
}

std::size_t Variant::bytes() const {
  return tree_bytes_ + reserved_ + bytes_for_a_leaf_pair_ * max_leaf_pairs_;
}

}  // namespace ist::bench
