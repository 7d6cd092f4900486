#include "ist/mesh/format/binary_content.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <utility>

namespace ist {

static_assert(std::endian::native == std::endian::little, "both formats are written as they lie");

namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

StlContent::StlContent() : bytes_(kStlCountEnd, '\0') {}

void StlContent::add_facet(const std::array<float, 9>& vertices) {
  append(bytes_, std::array<float, 3>{});  // normals are computed from the winding, never read
  append(bytes_, vertices);
  append(bytes_, std::uint16_t{0});
  ++facets_;
}

CheckedContent StlContent::finish() {
  const auto count = static_cast<std::uint32_t>(facets_);
  std::memcpy(bytes_.data() + kStlHeaderBytes, &count, sizeof count);
  return {"stl", std::move(bytes_), facets_};
}

// assimp 5.2 takes a first byte of 0x0A after the header for the rest of a line end. So vertex 0 is
// one at the origin that no face names, and the others are counted from 1.
PlyContent::PlyContent() { add_vertex({0, 0, 0}); }

void PlyContent::add_vertex(const std::array<float, 3>& vertex) { append(vertices_, vertex); }

void PlyContent::add_face(std::span<const std::uint32_t> corners) {
  append(faces_, static_cast<std::uint32_t>(corners.size()));
  for (const std::uint32_t corner : corners) append(faces_, corner + 1);
  ++face_count_;
}

CheckedContent PlyContent::finish() {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nelement face {}\n"
      "property list uint uint vertex_indices\nend_header\n",
      vertices() + 1, face_count_);
  bytes.reserve(bytes.size() + vertices_.size() + faces_.size());
  bytes += std::exchange(vertices_, {});
  bytes += std::exchange(faces_, {});
  return {"ply", std::move(bytes), face_count_};
}

}  // namespace ist
