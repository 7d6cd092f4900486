#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ist {

/// Decodes base64 of RFC 4648, padded or not; none for any other character or a length that no
/// bytes have.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

}  // namespace ist
