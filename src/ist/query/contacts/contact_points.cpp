#include "ist/query/contacts/contact_points.h"

#include <algorithm>
#include <limits>

#include "ist/base/assert.h"
#include "ist/query/contacts/contact_clusters.h"

namespace ist {
namespace {

constexpr std::size_t kMovedLeaves = 1 << 11;  // a power of two
constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

const SphereTree& with(const SphereTree& tree, SpherePolicy policy, const char* body) {
  tree.require(policy, body);
  return tree;
}

ContactScale scale_of(const SphereTree& fixed, const SphereTree& moving,
                      const ContactPointOptions& options) {
  IST_ASSERT(options.least_depth >= -2 && options.least_depth < 1);
  IST_ASSERT(options.growth >= 0 && options.growth <= 1);
  return ContactScale(fixed, moving, options.least_depth, options.growth);
}

}  // namespace

ContactPoints::ContactPoints(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                             const ContactPointOptions& options)
    : ContactPoints(fixed, moving, policy, options, ScopedFloatEnvironment()) {}

ContactPoints::ContactPoints(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                             const ContactPointOptions& options, const ScopedFloatEnvironment&)
    : fixed_(with(fixed, policy, "fixed")),
      moving_(with(moving, policy, "moving")),
      policy_(policy),
      scale_(scale_of(fixed, moving, options)),
      rates_(fixed, moving, scale_),
      fixed_parents_(fixed.octree()),
      moving_parents_(moving.octree()),
      ancestors_(fixed, moving, policy, fixed_parents_, moving_parents_, scale_),
      moved_(kMovedLeaves),
      touched_(moving_parents_,
               options.points > 0 ? std::max<std::size_t>(options.touched_leaves, 1) : 0),
      points_(options.points) {
  sums_.about = fixed.lattice().origin();
}

bool ContactPoints::begin(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  count_ = 0;
  touched_.clear();
  const Eigen::Vector3d about = sums_.about;
  sums_ = {};
  sums_.about = about;
  fixed_leaf_ = kNoLeaf;
  const auto relative = relative_pose(pose, fixed_.lattice(), moving_.lattice());
  begun_ = relative.has_value();
  if (!begun_) return false;
  pose_ = *relative;
  ancestors_.begin(pose_);
  if (++query_ == 0) {  // what was moved could be of one 2^32 queries ago
    query_ = 1;
    std::fill(moved_.begin(), moved_.end(), MovedLeaf{});
  }
  return true;
}

ContactLeaf ContactPoints::leaf_of(const SphereTree& tree, std::uint32_t leaf,
                                   const NodeParents& parents) const noexcept {
  ContactLeaf at = read_leaf(tree, policy_, leaf, parents.of(0, leaf));
  at.bound = at.bound.grown(scale_.grow);
  return at;
}

inline const ContactLeaf& ContactPoints::moved(std::uint32_t leaf) noexcept {
  MovedLeaf& moved = moved_[leaf & (kMovedLeaves - 1)];
  if (moved.query != query_ || moved.leaf != leaf) move(leaf, moved);
  return moved.at;
}

void ContactPoints::move(std::uint32_t leaf, MovedLeaf& to) const noexcept {
  to.query = query_;
  to.leaf = leaf;
  to.at = leaf_of(moving_, leaf, moving_parents_).in(pose_);
}

// Of the most that a pair could weigh.
inline double ContactPoints::share_of(const Contact& contact, const NodeBound& moving) noexcept {
  const double balls = ball_share(fixed_at_.bound, moving, scale_);
  if (!(balls > 0)) return 0;
  double rest = 1;
  if (policy_ == SpherePolicy::kSlab) {
    rest = std::min(rest, slab_overlap(fixed_at_.bound, moving) / scale_.width);
    if (!(rest > 0)) return 0;
  }
  return balls * std::min(rest, ancestors_.of(contact.fixed, contact.moving));
}

inline void ContactPoints::add(const PairTerms& pair) noexcept {
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

inline void ContactPoints::take(const Contact& contact) noexcept {
  if (contact.fixed != fixed_leaf_) {
    fixed_leaf_ = contact.fixed;
    fixed_at_ = leaf_of(fixed_, fixed_leaf_, fixed_parents_);
  }
  const ContactLeaf& moving = moved(contact.moving);
  PairTerms pair = pair_terms(fixed_at_, moving, scale_);
  if (!(pair.weight > 0)) return;
  pair.weight *= scale_.area * share_of(contact, moving.bound);
  if (!(pair.weight > 0)) return;
  add(pair);
  if (!points_.empty()) touched_.add(contact.moving, pair);
}

bool ContactPoints::take(std::span<const Contact> contacts) noexcept {
  const ScopedFloatEnvironment environment;
  if (!begun_) return false;
  for (const Contact& contact : contacts) take(contact);
  return true;
}

void ContactPoints::finish() noexcept {
  const ScopedFloatEnvironment environment;
  count_ = cluster(touched_, sums_.about, points_);
}

std::size_t ContactPoints::bytes() const noexcept {
  return fixed_parents_.bytes() + moving_parents_.bytes() + ancestors_.bytes() +
         moved_.size() * sizeof(MovedLeaf) + touched_.bytes() +
         points_.size() * sizeof(ContactPoint);
}

}  // namespace ist
