#include "ist/base/printable.h"

#include <bit>
#include <cstdint>

namespace ist {

std::size_t printable_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first < 0x20 || first == 0x7F ? 0 : 1;
  const auto length = static_cast<std::size_t>(std::countl_one(byte(0)));
  if (length < 2 || length > 4 || length > text.size()) return 0;
  std::uint32_t code = first & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::uint32_t kSmallest[] = {0xA0, 0x800, 0x10000};  // below 0xA0: control characters
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kSmallest[length - 2] || surrogate || code > 0x10FFFF ? 0 : length;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = printable_character(text);
    const std::string_view next = length == 0 ? "?" : text.substr(0, length);
    if (shown.size() + next.size() > most) break;
    shown += next;
    text.remove_prefix(next.size());
  }
  return shown;
}

}  // namespace ist
