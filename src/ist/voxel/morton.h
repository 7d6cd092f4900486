#pragma once

#include <array>
#include <cstdint>

namespace ist {

/// Cell indices along x, y and z.
using Cell = std::array<std::uint32_t, 3>;

/// Spreads the low 16 bits of `v` to every third bit.
[[nodiscard]] constexpr std::uint64_t spread_bits(std::uint64_t v) noexcept {
  v &= 0xFFFF;
  v = (v | v << 16) & 0x001F'0000'FF00'00FF;
  v = (v | v << 8) & 0x100F'00F0'0F00'F00F;
  v = (v | v << 4) & 0x10C3'0C30'C30C'30C3;
  v = (v | v << 2) & 0x1249'2492'4924'9249;
  return v;
}

/// Gathers 16 bits of `v`, every third one: the inverse of spread_bits.
[[nodiscard]] constexpr std::uint32_t gather_bits(std::uint64_t v) noexcept {
  v &= 0x1249'2492'4924'9249;
  v = (v | v >> 2) & 0x10C3'0C30'C30C'30C3;
  v = (v | v >> 4) & 0x100F'00F0'0F00'F00F;
  v = (v | v >> 8) & 0x001F'0000'FF00'00FF;
  v = (v | v >> 16) & 0xFFFF;
  return static_cast<std::uint32_t>(v);
}

/// Returns the Morton code of a cell, each index below 2^16: x in bits 0, 3, 6 …, y in 1, 4, 7 …, z
/// in 2, 5, 8 …. Codes in ascending order visit octant 0 … 7 of each octree node in turn. The
/// parent's code is `code >> 3`.
///
/// Source: G. M. Morton, A computer oriented geodetic data base, IBM, 1966.
[[nodiscard]] constexpr std::uint64_t morton_encode(const Cell& cell) noexcept {
  return spread_bits(cell[0]) | spread_bits(cell[1]) << 1 | spread_bits(cell[2]) << 2;
}

[[nodiscard]] constexpr Cell morton_decode(std::uint64_t code) noexcept {
  return {gather_bits(code), gather_bits(code >> 1), gather_bits(code >> 2)};
}

}  // namespace ist
