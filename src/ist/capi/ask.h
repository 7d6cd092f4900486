#pragma once

#include <Eigen/Geometry>

#include "ist/capi/guard.h"
#include "ist/query/contact.h"

namespace ist::capi {

/// A caller's sixteen numbers, column by column, as they are.
[[nodiscard]] Eigen::Isometry3d to_isometry(const double pose[16]) noexcept;

/// What a query's own status is told as; where it searched nothing, the message is kept.
[[nodiscard]] ist_status status_of(const Call& call, QueryStatus status);

}  // namespace ist::capi
