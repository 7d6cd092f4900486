#pragma once

#include "ist/base/progress.h"
#include "ist/capi/guard.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/signed_distance.h"

/// Conversions that the functions of ist_measure.h share.
namespace ist::capi {

/// Converts a caller's progress; NULL leaves the default, which always goes on.
[[nodiscard]] ist_status read_progress(const Call& call, const ist_progress* given,
                                       Proceed& proceed);

/// Stores the message of a call that was ended by its progress.
ist_status cancelled(const Call& call);

[[nodiscard]] ist_surface_distance surface_distance_of(const SurfaceDistance& found) noexcept;

}  // namespace ist::capi
