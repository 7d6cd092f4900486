#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "ist/base/api.h"
#include "ist/capi/ist_c.h"

namespace ist::capi {

/// The size of a thread's error message, with its terminating zero.
inline constexpr std::size_t kLastErrorBytes = 512;

/// Returns the calling thread's message; empty before the first error.
[[nodiscard]] const char* last_error() noexcept;

/// One call of a C function. Its members report errors.
class IST_LOOP_API Call {
 public:
  explicit Call(const char* function) : function_(function) {}

  /// Stores `function: text` as the calling thread's message, cut to kLastErrorBytes, and returns
  /// the status. Allocates no memory.
  ist_status store(ist_status status, std::string_view text) const noexcept;
  /// Stores a formatted text, as store() does.
  template <typename... Args>
  ist_status fail(ist_status status, fmt::format_string<const Args&...> text,
                  const Args&... args) const {
    return store_formatted(status, text, fmt::make_format_args(args...));
  }

  /// A required pointer and its name.
  struct Needed {
    const char* name;
    const void* pointer;
  };
  /// Fails for the first pointer that is NULL.
  [[nodiscard]] ist_status need(std::initializer_list<Needed> all) const {
    for (const Needed& needed : all) {
      if (needed.pointer == nullptr) {
        return fail(IST_NULL_ARGUMENT, "{} is NULL: pass a valid pointer", needed.name);
      }
    }
    return IST_OK;
  }
  /// Fails for an array that is NULL but not empty, and for an impossible length.
  [[nodiscard]] ist_status need_array(const char* name, const void* array,
                                      std::size_t count) const {
    constexpr std::size_t kMost = PTRDIFF_MAX / 256;  // no element is larger than 256 bytes
    if (count > kMost) {
      return fail(IST_ARGUMENT_INVALID, "{} has {} elements: pass at most {}", name, count, kMost);
    }
    if (array != nullptr || count == 0) return IST_OK;
    return fail(IST_NULL_ARGUMENT, "{} is NULL: pass an array of {} elements", name, count);
  }

  /// Converts the current exception to a status and stores its message.
  [[nodiscard]] ist_status fail_by_exception() const noexcept;

 private:
  // Not a template: one formatter serves the whole interface.
  ist_status store_formatted(ist_status status, fmt::string_view text, fmt::format_args args) const;

  const char* function_;
};

/// Runs the body of a C function and converts any exception to a status.
template <typename Body>
ist_status guarded(const char* function, const Body& body) noexcept {
  const Call call(function);
  try {
    return body(call);
  } catch (...) {
    return call.fail_by_exception();
  }
}

}  // namespace ist::capi
