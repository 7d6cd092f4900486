#pragma once

#include <fmt/format.h>

#include "ist/base/error.h"

namespace ist {

/// Throws an Error of a formatted text.
template <typename... Args>
[[noreturn]] void throw_error(ErrorCode code, fmt::format_string<const Args&...> text,
                              const Args&... args) {
  throw Error(code, fmt::format(text, args...));
}

}  // namespace ist
