#pragma once

#include "ist/capi/follower.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/signed_distance.h"

/// Conversions that the functions of ist_measure.h share.
namespace ist::capi {

[[nodiscard]] ist_surface_distance surface_distance_of(const SurfaceDistance& found) noexcept;

}  // namespace ist::capi
