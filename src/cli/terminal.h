#pragma once

#include <string>
#include <string_view>

namespace ist::cli {

enum class TextColour { kRed, kYellow, kBold };

/// Returns a text in a colour, where stdout is a terminal and NO_COLOR of the environment is not
/// set (no-color.org); else the text.
[[nodiscard]] std::string painted(std::string_view text, TextColour colour);

/// Writes what is buffered for stdout. Throws std::system_error where that fails.
void flush_stdout();

/// Throws std::system_error of the write to stdout that just failed.
[[noreturn]] void fail_stdout();

}  // namespace ist::cli
