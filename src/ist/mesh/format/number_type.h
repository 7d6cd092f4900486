#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "ist/mesh/format/text_reader.h"

namespace ist {

/// A type of numbers in a file, by its name in the file's format.
struct NumberType {
  std::string_view name;
  std::size_t size;  ///< bytes in a binary file
  bool is_integer;
  Precision precision;                ///< of a number written as text
  double (*number)(const char* raw);  ///< reads `size` bytes in the machine's byte order
};

/// Integers of 64 bits are rounded.
template <class T>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(T), std::is_integral_v<T>,
          std::is_same_v<T, float> ? Precision::kFloat : Precision::kDouble, [](const char* raw) {
            T value;
            std::memcpy(&value, raw, sizeof(T));
            return static_cast<double>(value);
          }};
}

/// Returns the number in `type.size` bytes. This machine is little-endian.
[[nodiscard]] inline double number_in(const char* bytes, const NumberType& type, bool big_endian) {
  if (!big_endian) return type.number(bytes);
  std::array<char, sizeof(double)> raw;
  std::reverse_copy(bytes, bytes + type.size, raw.begin());
  return type.number(raw.data());
}

}  // namespace ist
