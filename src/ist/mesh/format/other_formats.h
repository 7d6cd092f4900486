#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace ist {

/// A format that the first bytes tell, and that no reader of libist reads.
struct OtherFormat {
  std::string_view begin, name;
  std::string_view ending = "";  ///< assimp's for it, or 3mf; empty if ist-import does not read it
  std::size_t at = 0;            ///< bytes before `begin`
};

/// Returns the format of a content without a byte order mark, or nullptr.
[[nodiscard]] const OtherFormat* other_format(std::string_view content);

/// Returns assimp's ending for a file of this name, or an empty text. ist-import reads the formats
/// of these names though their content may have no mark.
[[nodiscard]] std::string_view imported_ending(const std::filesystem::path& file);

/// Returns whether a byte is a control character other than a blank.
[[nodiscard]] bool is_control(char c);

/// Returns whether the content is a text. It may hold a few control bytes in names and comments,
/// and any number of zeros or Ctrl-Z at its end. In binary facets every 25th byte is 0.
[[nodiscard]] bool is_text(std::string_view content);

/// Returns whether an XML element begins in the first 4096 bytes.
[[nodiscard]] bool begins_with_element(std::string_view content, std::string_view element);

}  // namespace ist
