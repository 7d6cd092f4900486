#pragma once

#include <cstddef>
#include <string_view>

namespace ist::capi {

/// Of a thread's last error message, with the zero that ends it.
inline constexpr std::size_t kLastErrorBytes = 512;

/// Keeps `place: text` as the calling thread's message; what is too long is cut. No allocation.
void set_last_error(std::string_view place, std::string_view text) noexcept;

/// The calling thread's message; empty before the first.
[[nodiscard]] const char* last_error() noexcept;

}  // namespace ist::capi
