#include "ist/query/contacts/contact_reducer.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/error.h"
#include "ist/query/contacts/contact_clusters.h"
#include "ist/tree/tree_parts.h"

namespace ist::detail {
namespace {

void require_in_range(const char* name, double value, double most) {
  if (value >= 0 && value <= most) return;  // no NaN
  throw Error(
      ErrorCode::kArgumentInvalid,
      fmt::format("manifold option {} is {}: give a number from 0 to {}", name, value, most));
}

const SphereTree& with(const SphereTree& tree, SpherePolicy policy, const char* body) {
  tree.require(policy, body);
  return tree;
}

ContactScale scale_of(const SphereTree& fixed, const SphereTree& moving,
                      const ManifoldOptions& options) {
  require_in_range("points", static_cast<double>(options.points), double{kMostItems});
  require_in_range("max_leaves", static_cast<double>(options.max_leaves), double{kMostItems});
  require_in_range("margin", options.margin, 2);
  require_in_range("reach", options.reach, 1);
  return ContactScale(fixed, moving, options.margin, options.reach);
}

}  // namespace

ContactReducer::ContactReducer(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, const ManifoldOptions& options,
                               const ScopedFloatEnvironment&)
    : fixed_(with(fixed, policy, "fixed")),
      moving_(with(moving, policy, "moving")),
      policy_(policy),
      scale_(scale_of(fixed, moving, options)),
      rates_(contact_rates(fixed_, moving_, policy, scale_)),
      bytes_(bytes_for(fixed, moving, options)),
      adder_(std::make_unique<ContactAdder>()),
      points_(options.points) {
  adder_->rule = contact_rule(scale_, rates_.lever);
  if (options.points > 0) {
    leaf_sums_.emplace(parts_of(fixed_).octree, std::max<std::size_t>(options.max_leaves, 1));
    adder_->stream = &*leaf_sums_;
  }
  sums_.about = fixed_.origin();
}

void ContactReducer::clear() noexcept {
  adder_->clear();
  if (leaf_sums_) leaf_sums_->clear();
  count_ = 0;
  sums_ = {};
  sums_.about = fixed_.origin();
}

void ContactReducer::finish(const RelativePose& pose, bool complete) noexcept {
  const ContactRule& rule = adder_->rule;
  const ContactTotals& totals = adder_->totals;
  // The units are those that the kernels used, rounding and all.
  const double weight = scale_.area / kContactUnit, lever = 0.5 / double{rule.half_per_lever},
               range = 1 / double{rule.per_range};
  const auto vector = [&](ContactSum place, double unit) {
    const auto at = [&](std::size_t i) {
      return unit * static_cast<double>(totals.sum[place + i]);
    };
    return turned(pose, {at(0), at(1), at(2)});
  };
  // Torques about the moving frame's origin become such about the fixed one's.
  const auto wrench = [&](ContactSum force, ContactSum torque, double unit) {
    const Eigen::Vector3d f = vector(force, unit);
    return Wrench{f, sum(vector(torque, lever * unit), cross_in_order(pose.translation, f))};
  };
  sums_.pairs = totals.counted;
  sums_.weight = weight * static_cast<double>(totals.sum[kWeightSum]);
  sums_.pressure = wrench(kForceSum, kTorqueSum, weight);
  sums_.spring = wrench(kSpringSum, kSpringTorqueSum, range * weight);
  if (!leaf_sums_ || !complete) return;
  leaf_sums_->close();
  const LeafSumUnits units{weight, lever, scale_.least_depth(), scale_.size, pose, sums_.about};
  count_ = cluster(*leaf_sums_, units, points_);
}

std::size_t ContactReducer::bytes_for(const SphereTree& fixed, const SphereTree& moving,
                                      const ManifoldOptions& options) {
  static_cast<void>(scale_of(fixed, moving, options));  // checks them
  if (options.points == 0) return sizeof(ContactAdder);
  return sizeof(ContactAdder) +
         LeafSums::bytes_for(parts_of(fixed).octree, std::max<std::size_t>(options.max_leaves, 1)) +
         options.points * sizeof(Contact);
}

}  // namespace ist::detail
