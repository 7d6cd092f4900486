#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>

#include "ist/capi/ist.h"
#include "ist/capi/last_error.h"

namespace ist::capi {

/// A call of a C function, which can fail.
class Call {
 public:
  explicit Call(const char* function) : function_(function) {}

  /// Keeps the message, `function: text`, and returns the status. Allocates nothing.
  template <typename... Args>
  ist_status fail(ist_status status, fmt::format_string<Args...> text, Args&&... args) const {
    char buffer[kLastErrorBytes];
    const auto end =
        fmt::format_to_n(buffer, kLastErrorBytes, text, std::forward<Args>(args)...).out;
    set_last_error(function_, {buffer, static_cast<std::size_t>(end - buffer)});
    return status;
  }

  /// What must not be NULL, by its name.
  struct Needed {
    const char* name;
    const void* pointer;
  };
  /// Fails for the first that is.
  [[nodiscard]] ist_status need(std::initializer_list<Needed> all) const {
    for (const Needed& needed : all) {
      if (needed.pointer == nullptr) {
        return fail(IST_NULL_ARGUMENT, "{} is NULL, and must not be", needed.name);
      }
    }
    return IST_OK;
  }
  /// Fails for an array that is NULL and not empty, and for one that cannot be.
  [[nodiscard]] ist_status need_array(const char* name, const void* array,
                                      std::size_t count) const {
    constexpr std::size_t kMost = PTRDIFF_MAX / 256;  // the bytes of so many can be counted
    if (count > kMost) {
      return fail(IST_ARGUMENT_INVALID, "{} elements of {}: no memory has so many", count, name);
    }
    if (array != nullptr || count == 0) return IST_OK;
    return fail(IST_NULL_ARGUMENT, "{} is NULL, and should have {} elements", name, count);
  }

  /// The exception that is being handled, as a status; keeps its message.
  [[nodiscard]] ist_status fail_by_exception() const noexcept;

 private:
  const char* function_;
};

/// Runs the body of a C function: an exception that would leave it becomes a status.
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
