#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ist/base/api.h"
#include "ist/capi/ist_c.h"

namespace ist::capi {

/// The size of a thread's error message, with its terminating zero.
inline constexpr std::size_t kLastErrorBytes = 512;

/// Returns the calling thread's message; empty before the first error.
[[nodiscard]] const char* last_error() noexcept;

/// One call of a C function. Its members report errors, and it keeps the first one: a check after
/// it stores nothing. A function may therefore make all its checks before it looks at the status.
class IST_LOOP_API Call {
 public:
  explicit Call(const char* function) : function_(function) {}

  /// IST_OK, or the first error.
  [[nodiscard]] ist_status status() const noexcept { return status_; }

  /// Keeps the status, and stores `function: text` as the calling thread's message, cut to
  /// kLastErrorBytes. Allocates no memory.
  void store(ist_status status, std::string_view text) noexcept;
  /// Stores a formatted text, as store() does.
  template <typename... Args>
  void fail(ist_status status, fmt::format_string<const Args&...> text, const Args&... args) {
    store_formatted(status, text, fmt::make_format_args(args...));
  }

  /// Fails for NULL. Returns whether the pointer is valid.
  bool need(const char* name, const void* pointer) {
    if (pointer == nullptr) fail(IST_NULL_ARGUMENT, "{} is NULL: pass a valid pointer", name);
    return pointer != nullptr;
  }
  /// Sets an output to zero or NULL. Fails if there is no place for it.
  template <typename Output>
  void clear(const char* name, Output* out) {
    if (need(name, out)) *out = Output{};
  }
  /// Fails for an array that is NULL but not empty, and for an impossible length.
  void need_array(const char* name, const void* array, std::size_t count) {
    constexpr std::size_t kMost = PTRDIFF_MAX / 256;  // no element is larger than 256 bytes
    if (count > kMost) {
      fail(IST_ARGUMENT_INVALID, "{} has {} elements: pass at most {}", name, count, kMost);
    } else if (array == nullptr && count > 0) {
      fail(IST_NULL_ARGUMENT, "{} is NULL: pass an array of {} elements", name, count);
    }
  }

  /// Converts the current exception to a status and stores its message.
  void fail_by_exception() noexcept;

 private:
  // Not a template: one formatter serves the whole interface.
  void store_formatted(ist_status status, fmt::string_view text, fmt::format_args args);

  const char* function_;
  ist_status status_ = IST_OK;
};

/// Runs the body of a C function and converts any exception to a status.
template <typename Body>
ist_status guarded(const char* function, const Body& body) noexcept {
  Call call(function);
  try {
    body(call);
  } catch (...) {
    call.fail_by_exception();
  }
  return call.status();
}

}  // namespace ist::capi
