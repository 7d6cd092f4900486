#include "ist/mesh/format/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace ist {
namespace {

constexpr std::uint8_t kNoDigit = 64;

constexpr std::array<std::uint8_t, 256> digit_table() {
  std::array<std::uint8_t, 256> table{};
  for (std::uint8_t& digit : table) digit = kNoDigit;
  std::uint8_t next = 0;
  for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                       "0123456789+/"))
    table[static_cast<unsigned char>(c)] = next++;
  return table;
}

// Appends the bytes of a text without padding. Returns false for another character.
bool append_base64(std::string_view text, std::string& bytes) {
  static constexpr std::array<std::uint8_t, 256> kDigits = digit_table();
  std::uint32_t bits = 0;
  int held = 0;  // bits not yet written
  for (const char c : text) {
    const std::uint8_t digit = kDigits[static_cast<unsigned char>(c)];
    if (digit == kNoDigit) return false;
    bits = bits << 6 | digit;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xFF);
  }
  return text.size() % 4 != 1;
}

}  // namespace

std::optional<std::string> decode_base64(std::string_view text, std::size_t bytes) {
  std::string decoded;
  while (decoded.size() < bytes) {
    // Whole groups of four, up to the padding.
    const std::size_t most = (bytes - decoded.size() + 2) / 3 * 4;
    std::string_view part = text.substr(0, std::min(text.find('='), most));
    const std::size_t taken = (part.size() + 3) / 4 * 4;
    const std::size_t padding = taken - part.size();
    if (part.empty() || padding > 2 ||
        !text.substr(part.size()).starts_with(std::string_view("==", padding)) ||
        !append_base64(part, decoded))
      return {};
    text.remove_prefix(taken);
  }
  decoded.resize(bytes);
  return decoded;
}

}  // namespace ist
