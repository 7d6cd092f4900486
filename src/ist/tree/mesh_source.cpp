#include "ist/tree/mesh_source.h"

#include <algorithm>

#include "ist/base/printable.h"

namespace ist {

std::string source_name(std::string_view text) {
  std::string name = printable(text, kMaxSourceName);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '\\'; }, '?');
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
