#include "support/mesh_files.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>
#include <stdexcept>

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

std::string as_vtk(const TriangleMesh& mesh) {
  const std::string triangles = std::to_string(mesh.triangles.size());
  std::string text = "# vtk DataFile Version 4.2\nmade by hand\nASCII\nDATASET POLYDATA\nPOINTS " +
                     std::to_string(mesh.vertices.size()) + " float\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) text += spelled(vertex) + "\n";
  text += "POLYGONS " + triangles + " " + std::to_string(4 * mesh.triangles.size()) + "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  return text;
}

std::string as_binary_vtk(const TriangleMesh& mesh) {
  const std::size_t triangles = mesh.triangles.size();
  std::string bytes =
      "# vtk DataFile Version 5.1\nmade by hand\nBINARY\nDATASET POLYDATA\nPOINTS " +
      std::to_string(mesh.vertices.size()) + " float\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double x : vertex) append(bytes, static_cast<float>(x), true);
  bytes += "\nPOLYGONS " + std::to_string(triangles + 1) + " " + std::to_string(3 * triangles) +
           "\nOFFSETS vtktypeint64\n";
  for (std::size_t i = 0; i <= triangles; ++i)
    append(bytes, static_cast<std::int64_t>(3 * i), true);
  bytes += "\nCONNECTIVITY vtktypeint64\n";
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) append(bytes, std::int64_t{vertex}, true);
  return bytes + "\n";
}

std::string as_vtp(const TriangleMesh& mesh) {
  const std::string triangles = std::to_string(mesh.triangles.size());
  const auto array = [](const std::string& type, const std::string& name, const std::string& data) {
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(data.size()));
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
           (name == "Points" ? "3" : "1") + "\" format=\"binary\">\n  " + base64(bytes + data) +
           "\n</DataArray>\n";
  };
  std::string points, corners, ends;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double x : vertex) append(points, static_cast<float>(x));
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) append(corners, vertex);
    append(ends, static_cast<std::int32_t>(corners.size() / sizeof(std::uint32_t)));
  }
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
         std::to_string(mesh.vertices.size()) + "\" NumberOfPolys=\"" + triangles +
         "\">\n<Points>\n" + array("Float32", "Points", points) + "</Points>\n<Polys>\n" +
         array("UInt32", "connectivity", corners) + array("Int32", "offsets", ends) +
         "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string gltf_buffer(const TriangleMesh& mesh) {
  std::string bytes;
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    for (const double x : vertex) append(bytes, static_cast<float>(x));
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) append(bytes, vertex);
  return bytes;
}

std::string gltf_json(const TriangleMesh& mesh, const std::string& uri) {
  const auto length = [](std::size_t bytes) { return "\"byteLength\":" + std::to_string(bytes); };
  const std::size_t vertices = mesh.vertices.size(), corners = 3 * mesh.triangles.size();
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
         std::to_string(vertices) +
         R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
         std::to_string(corners) + R"(}],"bufferViews":[{"buffer":0,)" + length(12 * vertices) +
         R"(},{"buffer":0,"byteOffset":)" + std::to_string(12 * vertices) + "," +
         length(4 * corners) + R"(}],"buffers":[{)" + length(12 * vertices + 4 * corners) +
         (uri.empty() ? "" : ",\"uri\":\"" + uri + "\"") + "}]}";
}

std::string as_gltf(const TriangleMesh& mesh) {
  return gltf_json(mesh, "data:application/octet-stream;base64," + base64(gltf_buffer(mesh)));
}

std::string as_glb(std::string json, std::string chunk) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(28 + json.size() + chunk.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(chunk.size()));
  return bytes + std::string("BIN\0", 4) + chunk;
}

std::string as_glb(const TriangleMesh& mesh) {
  return as_glb(gltf_json(mesh, ""), gltf_buffer(mesh));
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
          {"OFF", as_off(narrowed(mesh))},
          {"VTK", as_vtk(mesh)},
          {"binary VTK", as_binary_vtk(mesh)},
          {"VTP", as_vtp(mesh)},
          {"glTF", as_gltf(mesh)},
          {"GLB", as_glb(mesh)}};
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
