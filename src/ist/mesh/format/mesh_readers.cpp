#include "ist/mesh/format/mesh_readers.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/files.h"
#include "ist/mesh/format/other_formats.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/imported_mesh.h"

namespace ist {
namespace {

// Whether characters of a text are ASCII in two bytes each: half of them after a byte order mark,
// nine of ten without one.
bool is_utf16(std::string_view content) {
  const bool marked = content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF");
  const std::size_t pairs = std::min<std::size_t>(content.size(), 256) / 2;
  std::size_t low_first = 0, high_first = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    const char a = content[2 * i], b = content[2 * i + 1];
    if (a != 0 && !is_control(a) && b == 0) ++low_first;
    if (b != 0 && !is_control(b) && a == 0) ++high_first;
  }
  return pairs >= 8 && 10 * std::max(low_first, high_first) >= (marked ? 5 : 9) * pairs;
}

// Returns whether the first word behind comments is a keyword of an OFF, with or without a count.
// The ending .off replaces a keyword.
bool begins_like_off(std::string_view content, std::string_view file, std::string_view extension) {
  TextReader reader(content, file);
  std::string_view word;
  while (word.empty() && reader.next_line()) word = reader.word_before_comment();
  const std::size_t keyword = word.rfind("OFF");
  const bool is_count =
      word.find_first_not_of("0123456789", keyword == word.npos ? 0 : keyword + 3) == word.npos;
  const bool is_begin =
      !word.empty() && is_count && (keyword != word.npos || same_word(extension, ".off"));
  return is_begin && (is_text(content) || reader.word() == "BINARY");
}

bool is_tree(std::string_view content) {
  return std::equal(kTreeFileMagic.begin(), kTreeFileMagic.end(), content.begin(),
                    content.begin() + std::min(content.size(), kTreeFileMagic.size()),
                    [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
}

// Whether the first line of more than one word, comments skipped, is one of an OBJ; every lone word
// before it must be, too.
bool begins_like_obj(std::string_view content, std::string_view file) {
  TextReader reader(content, file, TextReader::LineEnd::kObj);
  while (reader.next_line()) {
    const std::string_view word = reader.word();
    if (word.starts_with('#')) continue;
    if (!is_obj_statement(word)) return false;
    if (!reader.word().empty()) return true;
  }
  return false;
}

}  // namespace

TriangleMesh read_content(std::string_view content, const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string extension = file.extension().string();
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

  if (is_tree(content))
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              "the file is a tree of IST; read it by read_tree, ist_tree_load or ist.load, or name "
              "the mesh that it was built from");
  if (has_size_of_binary_stl(content)) return read_binary_stl(content, name);
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  TextReader reader(content, name);
  const std::string_view first_word = reader.word_of_any_line();
  if (content.find_first_not_of(" \t\r\n") == content.npos)
    fail_mesh(ErrorCode::kMeshEmpty, name, "", "the file is empty; export the mesh again");
  if (first_word == "ply" && content.starts_with("ply")) return read_ply(content, name);
  if (content.starts_with(kVtkBegin)) return read_vtk(content, name);
  if (first_word.starts_with('<') && begins_with_element(content, "<VTKFile"))
    return read_vtp(content, name);
  if (is_utf16(content))
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              "the text is UTF-16; save it as UTF-8 or ASCII, or export the mesh again");
  const OtherFormat* const format = other_format(content);
  if (format != nullptr && !format->ending.empty()) return read_imported(content, file);
  if (format != nullptr)
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              fmt::format("the file's format is {}, and the supported formats are {}; export the "
                          "mesh as one of them",
                          format->name, readable_formats()));
  if (begins_like_off(content, name, extension)) return read_off(content, name);
  if (is_text(content)) {
    if (same_word(first_word, "solid")) return read_text_stl(content, name);
    if (same_word(extension, ".obj") || begins_like_obj(content, name))
      return read_obj(content, name);
  }
  if (!imported_ending(file).empty()) return read_imported(content, file);
  // The rest is no mesh, a mesh that was cut early, or a binary STL of the wrong size. A text of
  // several lines, or one longer than an STL header, is neither of the last two.
  const bool could_be_cut = std::string_view("solid").starts_with(content) ||
                            std::string_view("ply").starts_with(content) ||
                            same_word(extension, ".stl");
  const bool could_be_header =
      content.size() <= kStlCountEnd && content.find_first_of("\r\n") == content.npos;
  if (is_text(content) ? could_be_cut && could_be_header
                       : could_be_cut || begins_like_binary_stl(content))
    return read_binary_stl(content, name);
  fail_mesh(
      ErrorCode::kNotAMesh, name, "",
      fmt::format("the content is in no supported format: {}; convert the mesh to one of them",
                  readable_formats()));
}

}  // namespace ist
