#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace ist::test {

/// The bytes as a specification writes them: "15 02 FF".
[[nodiscard]] inline std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    text += fmt::format("{}{:02X}", text.empty() ? "" : " ", static_cast<unsigned char>(byte));
  }
  return text;
}

}  // namespace ist::test
