#include "ist/mesh/format/other_formats.h"

#include <algorithm>

#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 && (byte < '\t' || byte > '\r');
}

bool is_text(std::string_view content) {
  content = content.substr(0, content.find_last_not_of(std::string_view("\0\x1A", 2)) + 1);
  const auto controls = std::count_if(content.begin(), content.end(), is_control);
  return static_cast<std::size_t>(controls) <= 4 + content.size() / 100;
}

bool begins_with_element(std::string_view content, std::string_view element) {
  return content.substr(0, 4096).find(element) != content.npos;
}

const OtherFormat* other_format(std::string_view content) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  static constexpr OtherFormat kFormats[] = {
      {"glTF", "glTF", "glb"},
      {"PK\3\4", "3MF", "3mf"},
      {"BLENDER", "Blender's"},
      {"LWO", "LightWave's", "lwo", 8},
      {"MM", "3DS", "3ds"},
      {"Kaydara FBX Binary", "FBX", "fbx"},
      {"; FBX", "FBX", "fbx"},
      {"xof ", "DirectX"},
      {"AC3D", "AC3D", "ac"},
      {"DRACO", "Draco"},
      {"ISO-10303-21", "STEP"},
      {"#VRML", "VRML"},
      {"OCTM", "OpenCTM"},
      {"DICM", "DICOM", "", 128},
      {"%PDF", "PDF"},
      {"\x89PNG", "PNG"},
      {"\x1F\x8B", "gzip, a packed file"},
  };
  for (const OtherFormat& format : kFormats) {
    const bool begins =
        content.size() > format.at && content.substr(format.at).starts_with(format.begin);
    const bool may_be_other =
        format.begin.size() == 2 && (is_text(content) || begins_like_binary_stl(content));
    if (begins && !may_be_other) return &format;
  }
  static constexpr OtherFormat kJson = {"{", "glTF", "gltf"}, kXml = {"<", "XML"};
  const std::string_view first_word = TextReader(content, "").word_of_any_line();
  if (first_word.starts_with(kJson.begin)) return &kJson;
  if (!first_word.starts_with(kXml.begin)) return nullptr;
  static constexpr OtherFormat kElements[] = {{"<COLLADA", "COLLADA", "dae"},
                                              {"<X3D", "X3D", "x3d"},
                                              {"<amf", "AMF", "amf"},
                                              {"<svg", "SVG"},
                                              {"<html", "HTML"}};
  for (const OtherFormat& format : kElements) {
    if (begins_with_element(content, format.begin)) return &format;
  }
  return &kXml;
}

std::string_view imported_ending(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  for (const std::string_view name : {".3ds", ".fbx"}) {
    if (same_word(name, extension)) return name.substr(1);
  }
  return {};
}

}  // namespace ist
