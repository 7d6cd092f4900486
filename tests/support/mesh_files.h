#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// A mesh as the bytes of a file, coordinates narrowed to float and spelled so that they come back
/// the same. Plain: what most programs write. An OBJ
/// and an OFF hold doubles, which are not narrowed.
[[nodiscard]] std::string as_binary_stl(const TriangleMesh& mesh, std::string header = "");
[[nodiscard]] std::string as_text_stl(const TriangleMesh& mesh);
[[nodiscard]] std::string as_text_ply(const TriangleMesh& mesh);
[[nodiscard]] std::string as_binary_ply(const TriangleMesh& mesh, bool big_endian);
[[nodiscard]] std::string as_obj(const TriangleMesh& mesh);
[[nodiscard]] std::string as_off(const TriangleMesh& mesh);
/// Legacy VTK PolyData: text of version 4.2, or bytes of version 5.1.
[[nodiscard]] std::string as_vtk(const TriangleMesh& mesh);
[[nodiscard]] std::string as_binary_vtk(const TriangleMesh& mesh);
/// VTK's XML PolyData with inline base64.
[[nodiscard]] std::string as_vtp(const TriangleMesh& mesh);
[[nodiscard]] std::string as_gltf(const TriangleMesh& mesh);
[[nodiscard]] std::string as_glb(const TriangleMesh& mesh);
/// A GLB of a JSON and its binary chunk.
[[nodiscard]] std::string as_glb(std::string json, std::string chunk);
/// Returns the JSON of a glTF with one mesh in one buffer. An empty `uri` is left out.
[[nodiscard]] std::string gltf_json(const TriangleMesh& mesh, const std::string& uri);
/// That buffer: the vertices as floats, then the indices in 32 bits.
[[nodiscard]] std::string gltf_buffer(const TriangleMesh& mesh);
[[nodiscard]] std::string base64(std::string_view bytes);

/// All of these forms, narrowed, by name, and those that mislead: a binary STL whose header begins
/// like text.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> all_formats(
    const TriangleMesh& mesh);

/// The triangles by their corners, whatever the indices.
[[nodiscard]] std::vector<std::array<double, 9>> corners(const TriangleMesh& mesh);

/// The mesh with its coordinates rounded to float.
[[nodiscard]] TriangleMesh narrowed(TriangleMesh mesh);

/// The text with every `from` turned into `to`.
[[nodiscard]] std::string replaced(std::string text, const std::string& from,
                                   const std::string& to);

/// A binary little-endian PLY whose vertices have properties of float, int and uchar and whose
/// faces are lists.
struct PlyFile {
  std::vector<std::pair<std::string, std::string>> properties;  ///< kind and name, in order
  std::vector<std::map<std::string, double>> vertices;          ///< by the names of properties
  std::vector<std::vector<std::uint32_t>> faces;
};

/// Reads a PLY file of the command. Throws std::runtime_error for another header, and for too few
/// or too many bytes.
[[nodiscard]] PlyFile parse_ply(const std::string& bytes);

}  // namespace ist::test
