#pragma once

#include <array>
#include <cstdint>

namespace ist {

/// The positions of the set bits of each byte, lowest first, then zeros.
inline constexpr std::array<std::array<std::uint8_t, 8>, 256> kSetBits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> places{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    std::size_t count = 0;
    for (std::uint8_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1) != 0) places[byte][count++] = bit;
    }
  }
  return places;
}();

}  // namespace ist
