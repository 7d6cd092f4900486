#pragma once

#include <string>
#include <string_view>

namespace ist::cli {

enum class TextColour { kRed, kYellow, kBold };

/// Returns a text in a colour, where stdout is a terminal and NO_COLOR of the environment is not
/// set (no-color.org); else the text.
[[nodiscard]] std::string painted(std::string_view text, TextColour colour);

}  // namespace ist::cli
