#include "ist/mesh/format/mesh_readers.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/mesh/format/stl_layout.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

bool is_text(std::string_view content) {
  // Some programs end a text with NUL or Ctrl-Z.
  const std::size_t last = content.find_last_not_of(std::string_view("\0\x1A", 2));
  return std::all_of(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(last + 1),
                     [](char c) {
                       const auto byte = static_cast<unsigned char>(c);
                       return byte >= 0x20 || (byte >= '\t' && byte <= '\r');
                     });
}

// Whether the first line of more than one word, comments skipped, is one of an OBJ; every lone word
// before it must be, too.
bool begins_like_obj(std::string_view content, std::string_view file) {
  TextReader reader(content, file, TextReader::LineEnd::kContinuedByBackslash);
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

  if (has_size_of_binary_stl(content)) return read_binary_stl(content, name);
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  TextReader reader(content, name);
  const std::string_view first_word = reader.word_of_any_line();
  if (content.find_first_not_of(" \t\r\n") == content.npos)
    fail_mesh(ErrorCode::kMeshEmpty, name, "", "the file is empty; export the mesh again");
  if (first_word == "ply" && content.starts_with("ply")) return read_ply(content, name);
  if (content.starts_with("glTF") || first_word.starts_with('{')) return read_gltf(content, name);
  if (content.starts_with("PK\3\4")) return read_3mf(content, name);
  if (first_word.starts_with('<') && content.find("<COLLADA") != content.npos)
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              "COLLADA is not supported; export the mesh as glTF (.glb), PLY or STL");
  if (first_word.ends_with("OFF") && (is_text(content) || reader.word() == "BINARY"))
    return read_off(content, name);
  if (is_text(content)) {
    if (same_word(first_word, "solid")) return read_text_stl(content, name);
    if (same_word(extension, ".obj") || begins_like_obj(content, name))
      return read_obj(content, name);
  }
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
                  kMeshFormats));
}

}  // namespace ist
