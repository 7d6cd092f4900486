#include "ist/tree/mesh_source.h"

#include <bit>
#include <cstdint>

namespace ist {
namespace {

// Returns the bytes of the UTF-8 character that `text` begins with; 0 for none, for a control
// character and for a path separator. Precondition: `text` is not empty.
std::size_t allowed_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) {
    return first < 0x20 || first == 0x7F || first == '/' || first == '\\' ? 0 : 1;
  }
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

}  // namespace

std::string source_name(std::string_view text) {
  std::string name;
  while (!text.empty()) {
    const std::size_t length = allowed_character(text);
    const std::string_view next = length == 0 ? "?" : text.substr(0, length);
    if (name.size() + next.size() > kMaxSourceName) break;
    name += next;
    text.remove_prefix(next.size());
  }
  return name;
}

const char* source_flaw(const MeshSource& source) {
  if (source.name.size() > kMaxSourceName) return "the mesh's name is longer than 255 bytes";
  if (source.name != source_name(source.name)) {
    return "the mesh's name has a path separator, a control character, or bytes that are not UTF-8";
  }
  return to_string(source.unit).empty() ? "the unit of length is out of range" : nullptr;
}

}  // namespace ist
