#pragma once

#include <array>
#include <cstdint>

#include "ist/hardware/table_rom.h"
#include "ist/tree/lookup_table_search.h"

/// The words of the table's ROM, made at compile time for compile-time proofs.
namespace ist {

static_assert(kRadiusSquared == kTableSquares && kNoRadius == kNoRadiusCode);

constexpr std::array<std::uint16_t, 256> make_table_rom() {
  const LookupTable table = lookup_table_detail::make_lookup_table();
  std::array<std::uint16_t, 256> rom{};
  for (std::size_t mask = 0; mask < rom.size(); ++mask) {
    rom[mask] = static_cast<std::uint16_t>(lookup_table_detail::word_of(table[mask]));
  }
  return rom;
}

inline constexpr std::array<std::uint16_t, 256> kRomWords = make_table_rom();

}  // namespace ist
