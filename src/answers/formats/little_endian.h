#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "answers/formats/poly_data.h"

namespace ist::answers {

static_assert(std::endian::native == std::endian::little,
              "the files are little-endian, and arrays are written as they lie in memory");
static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(Colour) == 3);

/// Appends a number as it lies in memory.
template <typename T>
void append_bytes(std::string& bytes, T number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

/// Returns the numbers of an array as they lie in memory.
[[nodiscard]] inline std::span<const std::byte> bytes_of(const Numbers& numbers) {
  return std::visit([](const auto& all) { return std::as_bytes(std::span(all)); }, numbers);
}

/// Returns the name that a format has for the kind of the numbers.
[[nodiscard]] inline const char* kind_of(const Numbers& numbers, const char* float32,
                                         const char* int32, const char* uint8) {
  if (std::holds_alternative<std::vector<float>>(numbers)) return float32;
  return std::holds_alternative<std::vector<std::int32_t>>(numbers) ? int32 : uint8;
}

}  // namespace ist::answers
