#include "ist/mesh/format/binary_content.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <utility>

namespace ist {

static_assert(std::endian::native == std::endian::little,
              "both formats are written in the machine's byte order");

namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

// assimp 5.2 skips a first byte of 0x0A after the header as part of a line end. So vertex 0 is an
// unused one at the origin, and the file's vertices count from 1.
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
