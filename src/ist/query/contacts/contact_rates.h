#pragma once

#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_scale.h"
#include "ist/query/manifold.h"

namespace ist {

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
