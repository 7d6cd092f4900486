#include "ist/mesh/format/mesh_readers.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/mesh/format/stl_layout.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 && (byte < '\t' || byte > '\r');
}

// Text may hold a few control bytes in names and comments, and any number of zeros or Ctrl-Z at its
// end. In binary facets every 25th byte is 0.
bool is_text(std::string_view content) {
  content = content.substr(0, content.find_last_not_of(std::string_view("\0\x1A", 2)) + 1);
  const auto controls = std::count_if(content.begin(), content.end(), is_control);
  return static_cast<std::size_t>(controls) <= 4 + content.size() / 100;
}

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

// Returns the name of a format that is not read, or an empty text.
std::string_view other_format(std::string_view content, std::string_view first_word) {
  struct Format {
    std::string_view begin, name;
    std::size_t at = 0;
  };
  static constexpr Format kFormats[] = {
      {"# vtk DataFile", "VTK"},
      {"BLENDER", "Blender's"},
      {"DRACO", "Draco"},
      {"LWO", "LightWave's", 8},
      {"MM", "3DS"},
      {"Kaydara FBX Binary", "FBX"},
      {"; FBX", "FBX"},
      {"ISO-10303-21", "STEP"},
      {"#VRML", "VRML"},
      {"xof ", "DirectX"},
      {"AC3D", "AC3D"},
      {"OCTM", "OpenCTM"},
      {"DICM", "DICOM", 128},
      {"%PDF", "PDF"},
      {"\x89PNG", "PNG"},
      {"\x1F\x8B", "gzip, a packed file"},
  };
  for (const Format& format : kFormats) {
    const bool begins =
        content.size() > format.at && content.substr(format.at).starts_with(format.begin);
    const bool may_be_other =
        format.begin.size() == 2 && (is_text(content) || begins_like_binary_stl(content));
    if (begins && !may_be_other) return format.name;
  }
  if (!first_word.starts_with('<')) return {};
  static constexpr Format kElements[] = {{"<COLLADA", "COLLADA"}, {"<VTKFile", "VTK"},
                                         {"<X3D", "X3D"},         {"<amf", "AMF"},
                                         {"<svg", "SVG"},         {"<html", "HTML"}};
  const std::string_view begin = content.substr(0, 4096);
  for (const Format& format : kElements) {
    if (begin.find(format.begin) != begin.npos) return format.name;
  }
  return "XML";
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

  if (has_size_of_binary_stl(content)) return read_binary_stl(content, name);
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  TextReader reader(content, name);
  const std::string_view first_word = reader.word_of_any_line();
  if (content.find_first_not_of(" \t\r\n") == content.npos)
    fail_mesh(ErrorCode::kMeshEmpty, name, "", "the file is empty; export the mesh again");
  if (first_word == "ply" && content.starts_with("ply")) return read_ply(content, name);
  if (content.starts_with("glTF") || first_word.starts_with('{')) return read_gltf(content, name);
  if (content.starts_with("PK\3\4")) return read_3mf(content, name);
  if (is_utf16(content))
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              "the text is UTF-16; save it as UTF-8 or ASCII, or export the mesh again");
  if (const std::string_view format = other_format(content, first_word); !format.empty())
    fail_mesh(ErrorCode::kNotAMesh, name, "",
              fmt::format("the file's format is {}, and the supported formats are {}; export the "
                          "mesh as one of them",
                          format, kMeshFormats));
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
