#pragma once

#include <array>
#include <cstdint>

#include "ist/hardware/table_rom.h"
#include "ist/tree/lookup_table_search.h"

/// The words of the table's ROM, made at compile time for compile-time proofs.
namespace ist {

// Returns the code of a coordinate: a sign, then a magnitude of 0, 2 or 3.
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
  const LookupTable table = lookup_table_detail::make_lookup_table();
  std::array<std::uint16_t, 256> rom{};
  for (std::size_t mask = 0; mask < rom.size(); ++mask) rom[mask] = word_of(table[mask]);
  return rom;
}

inline constexpr std::array<std::uint16_t, 256> kTableWords = make_table_rom();

}  // namespace ist
