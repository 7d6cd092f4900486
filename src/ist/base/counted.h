#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
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

/// Returns a number of bytes as messages quote it, such as "500 bytes" or "1.5 MB".
[[nodiscard]] inline std::string in_bytes(std::uint64_t bytes) {
  constexpr std::uint64_t kMegabyte = 1'000'000;
  if (bytes < kMegabyte) return counted(bytes, "byte");
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / kMegabyte);
}

}  // namespace ist
