#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ist::test {

/// A binary little-endian PLY whose vertices have properties of float, int and uchar and whose
/// faces are lists.
struct PlyFile {
  std::vector<std::pair<std::string, std::string>> properties;  ///< kind and name, in order
  std::vector<std::map<std::string, double>> vertices;          ///< by the names of properties
  std::vector<std::vector<std::uint32_t>> faces;
};

/// Reads what the command writes, and throws std::runtime_error for anything else: another header,
/// bytes too few or too many.
[[nodiscard]] PlyFile parse_ply(const std::string& bytes);

}  // namespace ist::test
