#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ist/base/api.h"
#include "ist/tree/lookup_table.h"

/// The lookup table as a circuit reads it. README.md in this folder describes words and units.
namespace ist {

/// Squared radii by radius code, in squares of units.
inline constexpr std::array<int, 5> kRadiusSquared = {27, 54, 81, 96, 108};

/// The radius code of mask 0, a node that holds nothing and is never hit.
inline constexpr unsigned kNoRadius = 7;

namespace table_rom_detail {

// A sign, then a magnitude of 0, 2 or 3.
constexpr unsigned code_of(int coordinate) {
  return static_cast<unsigned>(coordinate < 0 ? 4 - coordinate : coordinate);
}

constexpr std::uint16_t word_of(const TableBall& ball) {
  unsigned radius = kNoRadius;
  for (unsigned code = 0; code < kRadiusSquared.size(); ++code) {
    if (kRadiusSquared[code] == ball.radius_squared) radius = code;
  }
  return static_cast<std::uint16_t>(code_of(ball.x) | code_of(ball.y) << 3 | code_of(ball.z) << 6 |
                                    radius << 9);
}

constexpr std::array<std::uint16_t, 256> make_table_rom() {
  std::array<std::uint16_t, 256> rom{};
  for (std::size_t mask = 0; mask < rom.size(); ++mask) rom[mask] = word_of(kLookupTable[mask]);
  return rom;
}

// √(radius squared) · 2⁸, rounded up.
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

/// One 12-bit word a mask: [2:0] x code, [5:3] y code, [8:6] z code, [11:9] radius code.
inline constexpr std::array<std::uint16_t, 256> kTableRom = table_rom_detail::make_table_rom();

/// Radii of fixed nodes at level 0 by radius code, Q4.8 units, rounded up.
inline constexpr std::array<std::uint16_t, 5> kFixedRadii = table_rom_detail::make_fixed_radii();

/// Coordinate `axis` of a word's centre, units: 0, ±2 or ±3.
[[nodiscard]] constexpr int rom_coordinate(std::uint16_t word, std::size_t axis) noexcept {
  const int code = word >> 3 * axis & 7;
  return (code & 4) != 0 ? -(code & 3) : code & 3;
}

/// The word's radius code: 0 … 4, or kNoRadius.
[[nodiscard]] constexpr unsigned rom_radius_code(std::uint16_t word) noexcept {
  return word >> 9 & 7u;
}

/// XXH64 of the 256 words, each as 16 bits, little endian.
[[nodiscard]] IST_API std::uint64_t table_checksum();

}  // namespace ist
