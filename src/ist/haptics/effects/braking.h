#pragma once

#include "ist/haptics/effects/effect.h"

namespace ist {

/// Adds to `response` what holds the tool back where it comes nearer: at each place of `places`
///
///     f = damping · share · max(0, -n · u / dt) · n
///
/// with u the way the place moves by `motion` in `dt` seconds. Nothing holds back what goes away or
/// along. At no motion there is no force, and a share fades where a place comes or goes, so that
/// the wrench is continuous. Precondition: dt > 0. Cost: some 150 flops a place.
void brake(const TouchSet& places, double damping, double dt, const Vector6& motion,
           Response& response) noexcept;

}  // namespace ist
