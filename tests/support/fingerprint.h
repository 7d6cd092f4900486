#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// FNV-1a over all bytes of a mesh.
[[nodiscard]] inline std::uint64_t fingerprint(const TriangleMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](const void* data, std::size_t size) {
    std::vector<unsigned char> bytes(size);
    std::memcpy(bytes.data(), data, size);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  };
  add(mesh.vertices.data(), mesh.vertices.size() * sizeof(mesh.vertices[0]));
  add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return hash;
}

}  // namespace ist::test
