#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ist {

/// Decodes base64 of RFC 4648, padded or not; none for any other character or a length that no
/// bytes have.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

/// Decodes the first `bytes` bytes of texts in base64 that stand one after the other, each padded.
/// Returns nothing for another character, or if the text ends early.
[[nodiscard]] std::optional<std::string> decode_base64_texts(std::string_view text,
                                                             std::size_t bytes);

}  // namespace ist
