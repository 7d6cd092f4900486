#pragma once

#include <optional>

#include "ist/base/error.h"
#include "ist/capi/ist_c.h"

namespace ist::capi {

/// Converts a code to its C number. The numbers never change, even if the order of ErrorCode does.
[[nodiscard]] ist_status status_of(ErrorCode code) noexcept;

/// Converts a C number to its code; empty for a number without an ErrorCode.
[[nodiscard]] std::optional<ErrorCode> error_code_of(ist_status status) noexcept;

}  // namespace ist::capi
