#include "ist/query/contacts/contact_reducer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "ist/base/error.h"
#include "ist/query/contacts/contact_clusters.h"
#include "ist/tree/tree_parts.h"

namespace ist::detail {
namespace {

constexpr std::size_t kMovedLeaves = 1 << 11;  // a power of two
constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

void require_in_range(const char* name, double value, double least, double most, const char* end) {
  if (value >= least && (value < most || (value == most && std::string_view(end) == "up to")))
    return;
  throw Error(ErrorCode::kArgumentInvalid,
              fmt::format("manifold option {} is {}: give a number from {} {} {}", name, value,
                          least, end, most));
}

const SphereTree& with(const SphereTree& tree, SpherePolicy policy, const char* body) {
  tree.require(policy, body);
  return tree;
}

ContactScale scale_of(const SphereTree& fixed, const SphereTree& moving,
                      const ManifoldOptions& options) {
  require_in_range("least_depth", options.least_depth, -2, 1, "below");
  require_in_range("points", static_cast<double>(options.points), 0, double{kMostItems}, "up to");
  require_in_range("max_leaves", static_cast<double>(options.max_leaves), 0, double{kMostItems},
                   "up to");
  require_in_range("margin", options.margin, 0, 1, "up to");
  return ContactScale(fixed, moving, options.least_depth, options.margin);
}

}  // namespace

ContactReducer::ContactReducer(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, const ManifoldOptions& options,
                               const ScopedFloatEnvironment&)
    : fixed_(with(fixed, policy, "fixed")),
      moving_(with(moving, policy, "moving")),
      policy_(policy),
      scale_(scale_of(fixed, moving, options)),
      rates_(contact_rates(fixed_, moving_, scale_)),
      fixed_parents_(fixed_.parts().octree),
      moving_parents_(moving_.parts().octree),
      ancestors_(fixed_, moving_, policy, fixed_parents_, moving_parents_, scale_),
      moved_(kMovedLeaves),
      leaf_sums_(moving_parents_,
                 options.points > 0 ? std::max<std::size_t>(options.max_leaves, 1) : 0),
      points_(options.points) {
  sums_.about = fixed.origin();
}

bool ContactReducer::begin(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  count_ = 0;
  leaf_sums_.clear();
  const Eigen::Vector3d about = sums_.about;
  sums_ = {};
  sums_.about = about;
  fixed_leaf_ = kNoLeaf;
  const auto relative = relative_pose(pose, fixed_.parts().lattice, moving_.parts().lattice);
  begun_ = relative.has_value();
  if (!begun_) return false;
  pose_ = *relative;
  ancestors_.begin(pose_);
  if (++query_ == 0) {  // after 2^32 queries a moved leaf could match by chance
    query_ = 1;
    std::fill(moved_.begin(), moved_.end(), MovedLeaf{});
  }
  return true;
}

ContactLeaf ContactReducer::leaf_of(const SphereTree& tree, std::uint32_t leaf,
                                    const NodeParents& parents) const noexcept {
  ContactLeaf at = read_leaf(tree, policy_, leaf, parents.of(0, leaf));
  at.bound = at.bound.inflated(scale_.margin);
  return at;
}

inline const ContactLeaf& ContactReducer::moved(std::uint32_t leaf) noexcept {
  MovedLeaf& moved = moved_[leaf & (kMovedLeaves - 1)];
  if (moved.query != query_ || moved.leaf != leaf) move(leaf, moved);
  return moved.at;
}

void ContactReducer::move(std::uint32_t leaf, MovedLeaf& to) const noexcept {
  to.query = query_;
  to.leaf = leaf;
  to.at = leaf_of(moving_, leaf, moving_parents_).in(pose_);
}

// Returns the factor of the greatest weight that the bounds of a pair and of its ancestors give.
inline double ContactReducer::bound_weight(const LeafPair& leaf_pair,
                                           const NodeBound& moving) noexcept {
  const double balls = ball_weight(fixed_at_.bound, moving, scale_);
  if (!(balls > 0)) return 0;
  double rest = 1;
  if (policy_ == SpherePolicy::kSlab) {
    rest = std::min(rest, slab_overlap(fixed_at_.bound, moving) / scale_.width);
    if (!(rest > 0)) return 0;
  }
  return balls * std::min(rest, ancestors_.of(leaf_pair.fixed, leaf_pair.moving));
}

inline void ContactReducer::add(const PairTerms& pair) noexcept {
  const Eigen::Vector3d force = scaled(pair.weight, pair.normal);
  const Eigen::Vector3d torque = cross_in_order(pair.position, force);
  const double stretched = pair.depth - scale_.least_depth;
  ++sums_.pairs;
  sums_.weight += pair.weight;
  add_to(sums_.pressure.force, force);
  add_to(sums_.pressure.torque, torque);
  add_to(sums_.spring.force, scaled(stretched, force));
  add_to(sums_.spring.torque, scaled(stretched, torque));
}

inline void ContactReducer::take(const LeafPair& leaf_pair) noexcept {
  if (leaf_pair.fixed != fixed_leaf_) {
    fixed_leaf_ = leaf_pair.fixed;
    fixed_at_ = leaf_of(fixed_, fixed_leaf_, fixed_parents_);
  }
  const ContactLeaf& moving = moved(leaf_pair.moving);
  PairTerms pair = pair_terms(fixed_at_, moving, scale_);
  if (!(pair.weight > 0)) return;
  pair.weight *= scale_.area * bound_weight(leaf_pair, moving.bound);
  if (!(pair.weight > 0)) return;
  add(pair);
  if (!points_.empty()) leaf_sums_.add(leaf_pair.moving, pair);
}

bool ContactReducer::take(std::span<const LeafPair> leaf_pairs) noexcept {
  const ScopedFloatEnvironment environment;
  if (!begun_) return false;
  for (const LeafPair& leaf_pair : leaf_pairs) take(leaf_pair);
  return true;
}

void ContactReducer::finish() noexcept {
  const ScopedFloatEnvironment environment;
  count_ = cluster(leaf_sums_, sums_.about, points_);
}

std::size_t ContactReducer::bytes() const noexcept {
  return fixed_parents_.bytes() + moving_parents_.bytes() + ancestors_.bytes() +
         moved_.size() * sizeof(MovedLeaf) + leaf_sums_.bytes() + points_.size() * sizeof(Contact);
}

}  // namespace ist::detail
