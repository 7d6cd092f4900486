#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Adds to `response` a one-sided damper at each point of `contacts`:
///
///     f = damping · stiffness_fraction · max(0, -n · u / dt) · n
///
/// with the displacement u of the point from the fixed body, by `motion` in `dt` seconds. A point
/// that recedes or slides has no force. The force is 0 without motion, and the fraction fades where
/// a point appears or vanishes, so the wrench is continuous. Precondition: dt > 0. Cost: some 150
/// flops a point.
inline void brake(const ToolContacts& contacts, double damping, double dt, const Vector6& motion,
                  Response& response) noexcept {
  for (const ContactPair& pair : contacts.pairs()) {
    const Vector6 relative = motion - pair.drift;
    for (const ToolContact& point : contacts.points(pair)) {
      const double approach = -point.normal.dot(point.moved(relative));
      if (!(approach > 0)) continue;
      const double slope = damping * point.stiffness_fraction / dt;
      response.add(point.arm, slope * approach * point.normal,
                   slope * (point.normal * point.normal.transpose()));
    }
  }
}

}  // namespace ist
