#include "support/mesh_files.h"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace ist::test {
namespace {

std::string spelled(double coordinate) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, static_cast<float>(coordinate)).ptr;
  return {text, end};
}

std::string spelled_exactly(const Eigen::Vector3d& v) {
  std::string text;
  for (const double coordinate : v) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, coordinate).ptr) += ' ';
  }
  text.pop_back();
  return text;
}

std::string spelled(const Eigen::Vector3d& v) {
  return spelled(v.x()) + ' ' + spelled(v.y()) + ' ' + spelled(v.z());
}

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string ply_header(const TriangleMesh& mesh, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " +
         std::to_string(mesh.vertices.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

// Through memory: g++ 12.2 drops the rounding of two doubles to float and back (its SLP vectoriser
// takes the pair of conversions for none).
double narrowed(double x) {
  const volatile auto narrow = static_cast<float>(x);
  return static_cast<double>(narrow);
}

}  // namespace

std::string as_binary_stl(const TriangleMesh& mesh, std::string header) {
  header.resize(80);
  append(header, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    header.append(12, '\0');
    for (const std::uint32_t vertex : triangle)
      for (const double x : mesh.vertices[vertex]) append(header, static_cast<float>(x));
    header.append(2, '\0');
  }
  return header;
}

std::string as_text_stl(const TriangleMesh& mesh) {
  std::string text = "solid made by hand\n";
  for (const Triangle& triangle : mesh.triangles) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (const std::uint32_t vertex : triangle)
      text += "      vertex " + spelled(mesh.vertices[vertex]) + "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid made by hand\n";
}

std::string as_text_ply(const TriangleMesh& mesh) {
  std::string text = ply_header(mesh, "ascii");
  for (const Eigen::Vector3d& vertex : mesh.vertices) text += spelled(vertex) + "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  return text;
}

std::string as_binary_ply(const TriangleMesh& mesh, bool big_endian) {
  std::string bytes = ply_header(mesh, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double x : vertex) append(bytes, static_cast<float>(x), big_endian);
  for (const Triangle& triangle : mesh.triangles) {
    bytes += '\3';
    for (const std::uint32_t vertex : triangle)
      append(bytes, static_cast<std::int32_t>(vertex), big_endian);
  }
  return bytes;
}

std::string as_obj(const TriangleMesh& mesh) {
  std::string text = "# made by hand\nmtllib none.mtl\no thing\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) text += "v " + spelled_exactly(vertex) + "\n";
  text += "usemtl none\ns off\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " +
            std::to_string(c + 1) + "\n";
  return text;
}

std::string as_off(const TriangleMesh& mesh) {
  std::string text = "OFF\n# made by hand\n" + std::to_string(mesh.vertices.size()) + ' ' +
                     std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) text += spelled_exactly(vertex) + "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  return text;
}

std::vector<std::pair<std::string, std::string>> all_formats(const TriangleMesh& mesh) {
  return {{"binary STL", as_binary_stl(mesh)},
          {"binary STL named solid", as_binary_stl(mesh, "solid facet normal")},
          {"binary STL with a byte order mark", as_binary_stl(mesh, "\xFF\xFE \xEF\xBB\xBF")},
          {"text STL", as_text_stl(mesh)},
          {"text PLY", as_text_ply(mesh)},
          {"binary PLY", as_binary_ply(mesh, false)},
          {"big-endian PLY", as_binary_ply(mesh, true)},
          {"OBJ", as_obj(narrowed(mesh))},
          {"OFF", as_off(narrowed(mesh))}};
}

std::vector<std::array<double, 9>> corners(const TriangleMesh& mesh) {
  std::vector<std::array<double, 9>> all;
  for (const Triangle& triangle : mesh.triangles) {
    auto& row = all.emplace_back();
    for (std::size_t i = 0; i < 9; ++i)
      row[i] = mesh.vertices[triangle[i / 3]][static_cast<Eigen::Index>(i % 3)];
  }
  return all;
}

TriangleMesh narrowed(TriangleMesh mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices)
    for (double& x : vertex) x = narrowed(x);
  return mesh;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace ist::test
