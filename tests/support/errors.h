#pragma once

#include <optional>
#include <string>

#include "ist/base/error.h"

namespace ist::test {

/// The error that `action` throws, or nothing. Any other exception fails the test by itself.
template <typename Action>
[[nodiscard]] std::optional<Error> error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

/// Its code's name, or "none": what a test compares and prints.
template <typename Action>
[[nodiscard]] std::string error_name(const Action& action) {
  const std::optional<Error> error = error_of(action);
  return error ? to_string(error->code()) : "none";
}

}  // namespace ist::test
