#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "ist/mesh/format/binary_content.h"

namespace ist {

/// A face with more corners is refused: cutting a polygon into triangles is quadratic or worse.
inline constexpr std::size_t kMaxCorners = 1024;

/// Finds out by the content alone which format a mesh file has (OBJ may also show by its name),
/// and checks the whole of it. The file is named in errors only.
///
/// Cost: linear in the content, whatever counts the file claims. Errors: kNotAMesh, kMeshEmpty,
/// kMeshPointsOnly, kMeshTruncated, kMeshBadIndex, kMeshNotFinite.
[[nodiscard]] CheckedContent check_content(std::string content, const std::filesystem::path& file);

/// The checks of each format; `file` is named in errors only.
[[nodiscard]] CheckedContent check_binary_stl(std::string content, std::string_view file);
[[nodiscard]] CheckedContent check_text_stl(std::string_view content, std::string_view file);
[[nodiscard]] CheckedContent check_ply(std::string_view content, std::string_view file);
[[nodiscard]] CheckedContent check_obj(std::string_view content, std::string_view file);

/// Whether the size is the one that the facet count of a binary STL asks for.
[[nodiscard]] bool has_size_of_binary_stl(std::string_view content);
/// Whether the content could be a binary STL of the wrong size: it begins with whole facets, all
/// finite. Other data practically never does.
[[nodiscard]] bool begins_like_binary_stl(std::string_view content);
/// Whether the word is one that a line of an OBJ may begin with.
[[nodiscard]] bool is_obj_statement(std::string_view word);

}  // namespace ist
