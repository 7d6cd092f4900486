#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "ist/base/api.h"

namespace ist {

/// Returns the bytes of the UTF-8 character that `text` begins with, at most 4; 0 for a control
/// character and for a byte that begins no character. Precondition: `text` is not empty.
[[nodiscard]] std::size_t printable_character(std::string_view text);

/// Returns a piece of a file as a message quotes it, so that no terminal obeys it and no NUL ends
/// the message: '?' stands for each byte of a control character and of text that is not UTF-8. The
/// result has at most `most` bytes, cut between two characters: the file may not be text at all.
[[nodiscard]] IST_LOOP_API std::string printable(std::string_view text, std::size_t most = 40);

}  // namespace ist
