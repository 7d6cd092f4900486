#pragma once

#include <optional>

#include "ist/base/error.h"
#include "ist/capi/ist.h"

namespace ist::capi {

/// The C interface's number of a code. Numbers are for ever, whatever order ErrorCode has.
[[nodiscard]] ist_status status_of(ErrorCode code) noexcept;

/// The other way; nothing for a number that is none of an ErrorCode.
[[nodiscard]] std::optional<ErrorCode> error_code_of(ist_status status) noexcept;

}  // namespace ist::capi
