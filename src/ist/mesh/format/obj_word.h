#pragma once

#include <string_view>

#include "ist/mesh/format/text_reader.h"

namespace ist {

/// Returns the next word of an OBJ's line, up to a comment. The '#' of "1.#IND", a printed NaN,
/// begins no comment.
[[nodiscard]] std::string_view obj_word(TextReader& reader);

}  // namespace ist
