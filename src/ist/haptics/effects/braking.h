#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Adds to `response` a one-sided damper at each of `points`:
///
///     f = damping · stiffness_fraction · max(0, -n · u / dt) · n
///
/// with the displacement u of the point by `motion` in `dt` seconds. A point that recedes or slides
/// has no force. The force is 0 without motion, and the fraction fades where a point appears or
/// vanishes, so the wrench is continuous. Precondition: dt > 0. Cost: some 150 flops a point.
inline void brake(const ToolContacts& points, double damping, double dt, const Vector6& motion,
                  Response& response) noexcept {
  for (const ToolContact& point : points.points()) {
    const double approach = -point.normal.dot(point.moved(motion));
    if (!(approach > 0)) continue;
    const double slope = damping * point.stiffness_fraction / dt;
    response.add(point.arm, slope * approach * point.normal,
                 slope * (point.normal * point.normal.transpose()));
  }
}

}  // namespace ist
