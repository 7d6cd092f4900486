#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/access.h"
#include "ist/base/float_environment.h"
#include "ist/query/contacts/contact_rates.h"
#include "ist/query/contacts/leaf_sums.h"
#include "ist/query/manifold.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/tree_parts.h"

namespace ist::detail {

/// Reduces the leaf pairs of an answer to sums that are Lipschitz in the pose and to a few contacts
/// (see cluster()).
///
/// A pair weighs s_f s_m · u · b · |e|, with s_f and s_m the two voxel sizes, u the overlap of the
/// two balls, b the lesser overlap of a slab with the other ball (bound_share), and e the mean of
/// the two normals, each as long as it is coherent (pair_terms). Each factor falls to 0, with a
/// bounded slope, where the pair leaves the answer or its normals cancel. With a margin below
/// 2 the weight also falls to 0 at the margin, over a quarter of a voxel.
///
/// The kernels add up, in float and fixed point, what their adder() is given; this class turns it
/// into mesh units and the fixed tree's frame.
///
/// The constructor reserves all memory: 80 kB, and with points LeafSums. A query
/// allocates nothing and locks nothing. One object belongs to one thread at a time.
class ContactReducer {
 public:
  /// Takes the policy of the query. Throws kPolicyMissing; kArgumentInvalid for an option out of
  /// range; std::bad_alloc.
  ContactReducer(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 const ManifoldOptions& options,
                 const ScopedFloatEnvironment& environment = ScopedFloatEnvironment());
  ContactReducer(const ContactReducer&) = delete;
  ContactReducer& operator=(const ContactReducer&) = delete;

  /// Forgets the query before.
  void clear() noexcept;
  /// Returns the sums of the kernels, to which a query adds its leaf pairs in order.
  [[nodiscard]] ContactAdder& adder() noexcept { return *adder_; }
  /// Returns the sums by leaf, to which the adder's terms go, or null where no points are wanted.
  [[nodiscard]] LeafSums* leaf_sums() noexcept { return leaf_sums_ ? &*leaf_sums_ : nullptr; }
  /// Makes sums of all that was added at a pose and, where that is complete, contacts.
  void finish(const RelativePose& pose, bool complete) noexcept;

  /// Returns the contacts, from finish() to the next clear().
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
    return &parts_of(fixed) == &parts_of(fixed_) && &parts_of(moving) == &parts_of(moving_) &&
           policy == policy_;
  }
  /// Returns the bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// Returns the bytes that a reducer for this fixed tree reserves. Throws kArgumentInvalid for an
  /// option out of range.
  [[nodiscard]] static std::size_t bytes_for(const SphereTree& fixed, const SphereTree& moving,
                                             const ManifoldOptions& options);

 private:
  const SphereTree fixed_, moving_;  // which share the content
  SpherePolicy policy_;
  ContactScale scale_;
  ContactRates rates_;
  std::size_t bytes_;
  std::unique_ptr<ContactAdder> adder_;
  std::optional<LeafSums> leaf_sums_;
  std::vector<Contact> points_;
  ContactSums sums_;
  std::size_t count_ = 0;
};

/// Returns the reducer that fills a manifold.
[[nodiscard]] inline ContactReducer& reducer_of(ContactManifold& manifold) noexcept {
  return Access::reducer(manifold);
}

}  // namespace ist::detail
