#include "ist/tree/mesh_source.h"

#include <fmt/format.h>

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

std::string contradiction(const SphereTree& a, std::string_view a_name, const SphereTree& b,
                          std::string_view b_name) {
  if (contradict(a.frame(), b.frame())) {
    return fmt::format("{} is in the frame {}, and {} is in {}: build both in one frame", a_name,
                       to_string(a.frame()), b_name, to_string(b.frame()));
  }
  const LengthUnit unit = a.source().unit, other = b.source().unit;
  if (!contradict(unit, other)) return {};
  return fmt::format(
      "{} is in {}, and {} is in {}: convert one mesh to the unit of the other, and "
      "build its tree again",
      a_name, to_string(unit), b_name, to_string(other));
}

}  // namespace ist
