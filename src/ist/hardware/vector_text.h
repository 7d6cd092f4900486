#pragma once

#include <string>
#include <string_view>

#include "ist/hardware/vector_file.h"

/// One line of a vector file.
namespace ist {

/// Adds the vector's line, with its end.
void append_line(const GoldenVector& vector, std::string& text);

/// The vector of a line without its end. Throws kInputInvalid and kFixedPointRange; `place`, file
/// and line, begins the text.
[[nodiscard]] GoldenVector read_line(std::string_view line, std::string_view place);

}  // namespace ist
