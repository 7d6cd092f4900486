#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ist/base/api.h"

/// @file
/// The lookup table in the format of the circuit. src/hardware/README.md describes words and units.
namespace ist {

/// The squared radii by radius code, squares of units.
inline constexpr std::array<int, 5> kRadiusSquared = {27, 54, 81, 96, 108};

/// The radius code of mask 0, an empty node, which is never hit.
inline constexpr unsigned kNoRadius = 7;

namespace table_rom_detail {

// Returns √(radius squared) · 2⁸ by radius code, rounded up.
constexpr std::array<std::uint16_t, 5> make_fixed_radii() {
  std::array<std::uint16_t, 5> radii{};
  for (std::size_t code = 0; code < radii.size(); ++code) {
    int radius = 0;
    while (radius * radius < kRadiusSquared[code] << 16) ++radius;
    radii[code] = static_cast<std::uint16_t>(radius);
  }
  return radii;
}

}  // namespace table_rom_detail

/// Returns the table, one 12-bit word a mask: [2:0] x code, [5:3] y code, [8:6] z code, [11:9]
/// radius code.
[[nodiscard]] IST_API const std::array<std::uint16_t, 256>& table_rom() noexcept;

/// The radii of fixed nodes at level 0 by radius code, Q4.8 units, rounded up.
inline constexpr std::array<std::uint16_t, 5> kFixedRadii = table_rom_detail::make_fixed_radii();

/// Returns coordinate `axis` of a word's centre, units: 0, ±2 or ±3.
[[nodiscard]] constexpr int rom_coordinate(std::uint16_t word, std::size_t axis) noexcept {
  const int code = word >> 3 * axis & 7;
  return (code & 4) != 0 ? -(code & 3) : code & 3;
}

/// Returns a word's radius code: 0 … 4, or kNoRadius.
[[nodiscard]] constexpr unsigned rom_radius_code(std::uint16_t word) noexcept {
  return word >> 9 & 7u;
}

/// Returns the XXH64 of the 256 words, each as 16 bits, little endian.
[[nodiscard]] IST_API std::uint64_t table_checksum();

}  // namespace ist
