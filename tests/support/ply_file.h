#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ist::test {

/// A binary little-endian PLY whose vertices have float properties and whose faces are lists.
struct PlyFile {
  std::vector<std::map<std::string, float>> vertices;  ///< by the names of their properties
  std::vector<std::vector<std::uint32_t>> faces;
};

/// Reads what `ist export` writes, and throws std::runtime_error for anything else: another header,
/// bytes too few or too many.
[[nodiscard]] PlyFile parse_ply(const std::string& bytes);

}  // namespace ist::test
