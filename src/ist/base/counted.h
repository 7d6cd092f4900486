#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace ist {

/// Returns a count with its noun, such as "1 triangle" or "2 triangles". `many` is the plural if it
/// is not `one` with an s.
template <std::integral Count>
[[nodiscard]] std::string counted(Count count, std::string_view one, std::string_view many = {}) {
  if (count == 1) return fmt::format("1 {}", one);
  return many.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, many);
}

}  // namespace ist
