#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ist/base/access.h"
#include "ist/base/api.h"
#include "ist/base/float_environment.h"
#include "ist/query/contacts/leaf_sums.h"
#include "ist/query/manifold.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "simd/contact_step.h"
#include "simd/lanes.h"

namespace ist {

/// The units and ranges of a leaf pair's numbers; the same whichever body is the fixed one.
struct ContactScale {
  double size;        ///< the mean of the two voxel sizes, mesh units: s
  double area;        ///< the product of the two sizes, mesh units²: the greatest weight
  double radius_sum;  ///< of two leaves' circumspheres, mesh units: √3 s
  double width;       ///< overlap of two bounds over which a weight fades in, mesh units: s/2
  double margin;      ///< distance at which springs begin, mesh units
  double fade;        ///< depth above the least over which a weight fades in; 0: at once
  double reach;       ///< greatest distance at which bounds count as overlapping, mesh units

  /// Takes the margin and the reach of ManifoldOptions. With a margin of 2 every leaf pair counts;
  /// with a smaller one only pairs that are near enough, and their weight begins at 0.
  ContactScale(const SphereTree& fixed, const SphereTree& moving, double margin_sizes = 0,
               double reach_sizes = 0) noexcept
      : size(0.5 * (fixed.voxel_size() + moving.voxel_size())),
        area(fixed.voxel_size() * moving.voxel_size()),
        radius_sum(kSqrt3 * size),
        width(0.5 * size),
        margin(margin_sizes * size),
        fade(margin_sizes < 2 ? 0.25 * size : 0),
        reach(reach_sizes * size) {}

  /// The least depth of a leaf pair, mesh units; the greatest is `size`.
  [[nodiscard]] double least_depth() const noexcept { return 0 - margin; }
};

/// Returns the rule by which kernels weigh leaf pairs; `lever`, mesh units, is no less than the
/// distance of any contact from the origin of the moving tree's frame.
[[nodiscard]] inline ContactRule contact_rule(const ContactScale& scale, double lever) noexcept {
  const double range = scale.size - scale.least_depth();
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {.per_ball = narrow(1 / (scale.radius_sum * scale.radius_sum)),
          .per_slab = narrow(1 / scale.width),
          .per_scaled_slab = narrow(1 / scale.width) / kSlabScale,
          .least = narrow(scale.least_depth()),
          .range = narrow(range),
          .per_range = narrow(1 / range),
          .fade_from = scale.fade > 0 ? 0.0F : 1.0F,
          .per_fade = scale.fade > 0 ? narrow(1 / scale.fade) : 0.0F,
          .half_per_lever = narrow(0.5 / lever)};
}

/// Returns the rates of two trees' contacts under a policy.
[[nodiscard]] inline ContactRates contact_rates(const SphereTree& fixed, const SphereTree& moving,
                                                SpherePolicy policy,
                                                const ContactScale& scale) noexcept {
  ContactRates rates{};
  const double s = scale.size;
  rates.lever = moving.bounding_radius() + (3 * s + scale.reach);
  const double far = fixed.bounding_radius() + (2.5 * s + scale.reach);
  const double radii = 1.02 * scale.radius_sum + scale.reach;
  const double squared = scale.radius_sum * scale.radius_sum, width = scale.width;
  // With slabs the steepest share is one where the centres are so far apart.
  const double apart = std::max(width, std::sqrt(std::max(0.0, radii * radii - squared)));
  const double slope = policy == SpherePolicy::kSlab
                           ? (radii * radii - apart * apart) / width + 2 * apart
                           : 2 * radii;
  const double share = scale.area * slope / squared;
  const double depth = scale.area * (1 + (3.9 * s + 0.5 * scale.reach) / rates.lever);
  rates.weight = share + 0.5 * scale.area / rates.lever + (scale.fade > 0 ? depth / scale.fade : 0);
  rates.pressure_force = rates.weight;
  rates.pressure_torque = far * rates.pressure_force + 0.5 * scale.area;
  rates.spring_force = 3 * s * share + (scale.fade > 0 ? 2 : 1) * depth;
  rates.spring_torque = far * rates.spring_force + 1.5 * s * scale.area;
  return rates;
}

/// Returns the Lipschitz constant of one leaf pair's depth: |change| <= rate · motion, where
/// `mean_normal` is the least length of the mean of the two normals during the motion. A contact's
/// depth has no such constant (docs/guarantees.md, Rates of the contact sums).
[[nodiscard]] inline double depth_rate(const ContactScale& scale, double lever,
                                       double mean_normal) noexcept {
  return 1 + (1.4 * scale.size + 0.5 * scale.reach) / (lever * mean_normal);
}

}  // namespace ist

namespace ist::detail {

/// The memory of a reduction: 80 kB, and with points the leaves. Several reducers may use it, one
/// after the other.
struct ContactWork {
  /// Reserves the sums of at most `leaves` leaves if points are wanted.
  ContactWork(const ManifoldOptions& options, std::size_t leaves);

  ContactAdder adder;
  std::optional<LeafSums> leaf_sums;
};

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
  /// Takes the policy of the query. Throws kVoxelsMissing, kPolicyMissing; kArgumentInvalid for an
  /// option out of range; std::bad_alloc.
  ContactReducer(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 const ManifoldOptions& options,
                 const ScopedFloatEnvironment& environment = ScopedFloatEnvironment());
  /// Reserves the contacts alone. It works in memory of others, and bind() has to follow.
  ContactReducer(const SphereTree& any, SpherePolicy policy, const ManifoldOptions& options);
  ContactReducer(const ContactReducer&) = delete;
  ContactReducer& operator=(const ContactReducer&) = delete;

  /// Reduces leaf pairs of two other trees from now on. Allocates nothing. Precondition: `work` has
  /// room for the leaves of the fixed tree.
  void bind(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
            ContactWork& work) noexcept;

  /// Forgets the query before.
  void clear() noexcept;
  /// Returns the sums of the kernels, to which a query adds its leaf pairs in order.
  [[nodiscard]] ContactAdder& adder() noexcept { return work_->adder; }
  /// Returns the sums by leaf, to which the adder's terms go, or null where no points are wanted.
  [[nodiscard]] LeafSums* leaf_sums() noexcept {
    return work_->leaf_sums ? &*work_->leaf_sums : nullptr;
  }
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
  /// Returns the most leaves that are kept apart for a fixed tree.
  [[nodiscard]] static std::size_t most_leaves(const SphereTree& fixed,
                                               const ManifoldOptions& options) noexcept;
  /// Returns the bytes of a ContactWork.
  [[nodiscard]] static std::size_t bytes_of_work(const ManifoldOptions& options,
                                                 std::size_t leaves) noexcept {
    return sizeof(ContactAdder) + (options.points > 0 ? leaves * sizeof(LeafSum) : 0);
  }
  /// Throws kArgumentInvalid for an option out of range.
  static void check(const ManifoldOptions& options);
  /// Returns the bytes that a reducer for this fixed tree reserves. Throws kVoxelsMissing, and
  /// kArgumentInvalid for an option out of range.
  [[nodiscard]] IST_LOOP_API static std::size_t bytes_for(const SphereTree& fixed,
                                                          const SphereTree& moving,
                                                          const ManifoldOptions& options);

 private:
  SphereTree fixed_, moving_;  // which share the content
  ManifoldOptions options_;
  SpherePolicy policy_;
  ContactScale scale_;
  ContactRates rates_;
  std::size_t bytes_;
  std::unique_ptr<ContactWork> own_;
  ContactWork* work_ = nullptr;
  std::vector<Contact> points_;
  ContactSums sums_;
  std::size_t count_ = 0;
};

/// Returns the reducer that fills a manifold.
[[nodiscard]] inline ContactReducer& reducer_of(ContactManifold& manifold) noexcept {
  return Access::reducer(manifold);
}

}  // namespace ist::detail
