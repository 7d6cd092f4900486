#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// The formats that read_content() reads, for messages and helps.
inline constexpr std::string_view kMeshFormats = "STL, PLY, OBJ, OFF, glTF or 3MF";

/// Reads the content of a mesh file, whose format the content tells (of an OBJ also the name). The
/// file itself is not opened.
///
/// Cost: linear in the content, for any counts that the file claims. Errors: kNotAMesh, kMeshEmpty,
/// kMeshPointsOnly, kMeshTruncated, kMeshBadIndex, kMeshNotFinite, kMeshTooLarge.
[[nodiscard]] TriangleMesh read_content(std::string_view content,
                                        const std::filesystem::path& file);

// No reader hands a file to assimp, the tests' second reader. Version 5.2 ends the process for JSON
// or XML nested deeply, for a 3MF's component or a COLLADA's node that holds itself, and for an
// accessor that counts too far. After the checks against all of these, nothing is left to read.

/// Reads the content of one format; `file` is named in errors only.
[[nodiscard]] TriangleMesh read_binary_stl(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_text_stl(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_ply(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_obj(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_off(std::string_view content, std::string_view file);
/// Both forms of glTF 2.0: text with its buffers in base64, and GLB.
[[nodiscard]] TriangleMesh read_gltf(std::string_view content, std::string_view file);
/// The core of 3MF, without its extensions.
[[nodiscard]] TriangleMesh read_3mf(std::string_view content, std::string_view file);

/// Whether the size matches the facet count of a binary STL.
[[nodiscard]] bool has_size_of_binary_stl(std::string_view content);
/// Whether the content could be a binary STL of the wrong size. It must begin with finite facets,
/// and have room for a 65,536th to 64 times as many facets as its header counts. Other data rarely
/// pass.
[[nodiscard]] bool begins_like_binary_stl(std::string_view content);
/// Whether a line of an OBJ may begin with `word`.
[[nodiscard]] bool is_obj_statement(std::string_view word);

}  // namespace ist
