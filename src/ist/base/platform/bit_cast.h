#pragma once

#include <type_traits>

namespace ist {

/// std::bit_cast, which libc++ lacks before its version 15.
template <class To, class From>
requires(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
         std::is_trivially_copyable_v<From>) [[nodiscard]] constexpr To
    bit_cast(const From& value) noexcept {
  return __builtin_bit_cast(To, value);
}

}  // namespace ist
