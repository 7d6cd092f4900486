#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ist {

/// Decodes the first `bytes` bytes of base64 (RFC 4648), padded. Several texts may stand one after
/// the other, each padded.
/// Returns nothing for another character, or if the text ends early.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text, std::size_t bytes);

}  // namespace ist
