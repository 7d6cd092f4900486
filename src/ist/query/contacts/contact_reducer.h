#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/query/contacts/ancestor_share.h"
#include "ist/query/contacts/contact_rates.h"
#include "ist/query/contacts/leaf_sums.h"
#include "ist/query/manifold.h"
#include "ist/query/traversal/leaf_pair_sink.h"

namespace ist::detail {

/// Reduces the leaf pairs of an answer, one after the other, to sums that are Lipschitz in the pose
/// and to a few contacts (see cluster()).
///
/// A pair weighs s_f s_m · u · b · |e|, with s_f and s_m the two voxel sizes, u the overlap of the
/// two balls (ball_weight), b the least overlap of both slabs and of all ancestors' bounds, and e
/// the mean of the two normals, each as long as it is coherent (pair_terms). Each factor falls to
/// 0, with a bounded slope, where the pair leaves the answer or its normals cancel. With a least
/// depth above -2 the weight also falls to 0 there, over a quarter of a voxel.
///
/// Query::contacts does all of it. To reduce a list of leaf pairs, call begin(), take() and
/// finish(); the list must be whole and sorted.
///
/// The constructor reserves all memory: 5.4 bytes a leaf of either tree, half a megabyte to a
/// megabyte of caches, and LeafSums where there are points. A query allocates nothing and locks
/// nothing. Holds references to both trees, which must outlive it; one object belongs to one thread
/// at a time. Cost: 40 to 100 ns a leaf pair, most where few of them share a leaf.
class ContactReducer final : public LeafPairStream {
 public:
  /// Takes the policy of the query. Throws kPolicyMissing; kArgumentInvalid for an option out of
  /// range; std::bad_alloc.
  ContactReducer(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 const ManifoldOptions& options,
                 const ScopedFloatEnvironment& environment = ScopedFloatEnvironment());
  ContactReducer(const ContactReducer&) = delete;
  ContactReducer& operator=(const ContactReducer&) = delete;

  /// Begins a query and forgets the one before. Returns false where `pose` is no rigid motion: then
  /// no leaf pair is taken, and the sums are 0.
  [[nodiscard]] bool begin(const Eigen::Isometry3d& pose) noexcept;
  /// Adds leaf pairs, sorted by fixed and then by moving leaf over all calls.
  bool take(std::span<const LeafPair> leaf_pairs) noexcept override;
  /// Makes the contacts.
  void finish() noexcept;

  /// Returns the contacts, from finish() to the next begin().
  [[nodiscard]] std::span<const Contact> points() const noexcept {
    return {points_.data(), count_};
  }
  [[nodiscard]] const ContactSums& sums() const noexcept { return sums_; }
  /// Returns the Lipschitz constants of the sums.
  [[nodiscard]] const ContactRates& rates() const noexcept { return rates_; }
  [[nodiscard]] const ContactScale& scale() const noexcept { return scale_; }

  [[nodiscard]] SpherePolicy policy() const noexcept { return policy_; }
  /// Returns whether leaf pairs of these trees under this policy may be reduced.
  [[nodiscard]] bool fits(const SphereTree& fixed, const SphereTree& moving,
                          SpherePolicy policy) const noexcept {
    return &fixed.parts() == &fixed_.parts() && &moving.parts() == &moving_.parts() &&
           policy == policy_;
  }
  /// Returns the bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  // A moving leaf in the fixed tree's frame, and the query that moved it.
  struct MovedLeaf {
    std::uint32_t query = 0;
    std::uint32_t leaf;
    ContactLeaf at;
  };
  void take(const LeafPair& leaf_pair) noexcept;
  [[nodiscard]] ContactLeaf leaf_of(const SphereTree& tree, std::uint32_t leaf,
                                    const NodeParents& parents) const noexcept;
  [[nodiscard]] double bound_weight(const LeafPair& leaf_pair, const NodeBound& moving) noexcept;
  void add(const PairTerms& pair) noexcept;
  [[nodiscard]] const ContactLeaf& moved(std::uint32_t leaf) noexcept;
  void move(std::uint32_t leaf, MovedLeaf& to) const noexcept;

  const SphereTree fixed_, moving_;  // which share the content
  SpherePolicy policy_;
  ContactScale scale_;
  ContactRates rates_;
  NodeParents fixed_parents_, moving_parents_;
  AncestorShare ancestors_;
  std::vector<MovedLeaf> moved_;  // cached by the last bits of the leaf
  LeafSums leaf_sums_;
  std::vector<Contact> points_;

  RelativePose pose_;
  std::uint32_t query_ = 0;
  bool begun_ = false;
  std::uint32_t fixed_leaf_ = 0;  // the leaf that fixed_at_ holds
  ContactLeaf fixed_at_;
  ContactSums sums_;
  std::size_t count_ = 0;
};

}  // namespace ist::detail
