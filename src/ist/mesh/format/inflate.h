#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace ist {

/// The most bytes that a file may unpack to, because a few bytes can claim any number.
inline constexpr std::size_t kMostUnpacked = std::size_t{1} << 29;
/// The most bytes that one packed byte becomes.
inline constexpr std::size_t kMostUnpackedRatio = 1032;

/// Whether this build has zlib.
[[nodiscard]] bool can_inflate();

/// Unpacks bytes that zlib packed. Returns false if they are damaged or become another number of
/// bytes than `unpacked` has, and in a build without zlib.
[[nodiscard]] bool inflate_bytes(std::string_view packed, std::span<char> unpacked);

}  // namespace ist
