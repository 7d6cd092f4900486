#include "support/ply_file.h"

#include <cstring>
#include <sstream>
#include <stdexcept>

namespace ist::test {

PlyFile parse_ply(const std::string& bytes) {
  const std::string end = "end_header\n";
  const std::size_t header_end = bytes.find(end);
  if (header_end == std::string::npos) throw std::runtime_error("no end of the header");
  std::istringstream header(bytes.substr(0, header_end));
  PlyFile ply;
  std::string line;
  std::size_t vertices = 0, faces = 0;
  bool lists = false;
  for (int number = 0; std::getline(header, line); ++number) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (number == 0 && line == "ply") continue;
    if (number == 1 && line == "format binary_little_endian 1.0") continue;
    if (first == "comment") continue;
    if (first == "element" && second == "vertex" && faces == 0) {
      vertices = std::stoul(third);
    } else if (first == "element" && second == "face") {
      faces = std::stoul(third);
    } else if (first == "property" && second != "list" && faces == 0) {
      ply.properties.emplace_back(second, third);
    } else if (line == "property list uchar int vertex_indices" && faces != 0) {
      lists = true;
    } else {
      throw std::runtime_error("strange line: " + line);
    }
  }
  if (lists != (faces != 0)) throw std::runtime_error("faces without indices");

  std::size_t at = header_end + end.size();
  const auto take = [&](auto value) {
    if (at + sizeof value > bytes.size()) throw std::runtime_error("it ends too early");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  for (std::size_t i = 0; i < vertices; ++i) {
    auto& vertex = ply.vertices.emplace_back();
    for (const auto& [kind, name] : ply.properties) {
      if (kind == "float") {
        vertex[name] = take(float{});
      } else if (kind == "int") {
        vertex[name] = take(std::int32_t{});
      } else if (kind == "uchar") {
        vertex[name] = take(std::uint8_t{});
      } else {
        throw std::runtime_error("strange kind of a property: " + kind);
      }
    }
  }
  for (std::size_t i = 0; i < faces; ++i) {
    auto& face = ply.faces.emplace_back(take(std::uint8_t{}));
    for (std::uint32_t& corner : face) corner = take(std::uint32_t{});
  }
  if (at != bytes.size()) throw std::runtime_error("it ends too late");
  return ply;
}

}  // namespace ist::test
