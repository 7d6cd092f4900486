#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "ist/mesh/format/binary_content.h"

namespace ist {

/// The largest number of corners of a face; a face with more is refused, because triangulation is
/// quadratic or worse.
inline constexpr std::size_t kMaxCorners = 1024;

/// Detects the format of a mesh file by its content (of an OBJ also by its name) and checks all of
/// the content. The file itself is not opened.
///
/// Cost: linear in the content, for any counts that the file claims. Errors: kNotAMesh, kMeshEmpty,
/// kMeshPointsOnly, kMeshTruncated, kMeshBadIndex, kMeshNotFinite.
[[nodiscard]] CheckedContent check_content(std::string content, const std::filesystem::path& file);

/// Checks the content of one format; `file` is named in errors only.
[[nodiscard]] CheckedContent check_binary_stl(std::string content, std::string_view file);
[[nodiscard]] CheckedContent check_text_stl(std::string_view content, std::string_view file);
[[nodiscard]] CheckedContent check_ply(std::string_view content, std::string_view file);
[[nodiscard]] CheckedContent check_obj(std::string_view content, std::string_view file);

/// Whether the size matches the facet count of a binary STL.
[[nodiscard]] bool has_size_of_binary_stl(std::string_view content);
/// Whether the content could be a binary STL of the wrong size: it begins with whole, finite
/// facets, as other data practically never does.
[[nodiscard]] bool begins_like_binary_stl(std::string_view content);
/// Whether a line of an OBJ may begin with `word`.
[[nodiscard]] bool is_obj_statement(std::string_view word);

}  // namespace ist
