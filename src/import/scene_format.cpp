#include "import/scene_format.h"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "ist/mesh/format/text_reader.h"

namespace ist::import {
namespace {

struct NamedUnit {
  std::string_view name, other_name;
  double centimetres;
  StatedUnit unit;
};

constexpr NamedUnit kUnits[] = {
    {"micron", "micrometer", 1e-4, {LengthUnit::kMicrometre, 1}},
    {"millimeter", "millimeters", 0.1, {LengthUnit::kMillimetre, 1}},
    {"centimeter", "centimeters", 1, {LengthUnit::kMillimetre, 10}},
    {"inch", "inches", 2.54, {LengthUnit::kInch, 1}},
    {"foot", "feet", 30.48, {LengthUnit::kInch, 12}},
    {"meter", "meters", 100, {LengthUnit::kMetre, 1}},
};

// The root names the unit by an attribute. The standard of AMF says millimetres without it.
StatedUnit unit_of_amf(std::string_view content) {
  const std::string_view begin = content.substr(content.find("<amf"));
  pugi::xml_document root;  // the parser keeps the open tag, though its end is missing
  root.load_buffer(begin.data(), std::min(begin.find('>'), begin.size()));
  return unit_of_name(root.first_child().attribute("unit").as_string("millimeter"));
}

}  // namespace

StatedUnit unit_of_name(std::string_view name) {
  for (const NamedUnit& unit : kUnits)
    if (same_word(name, unit.name) || same_word(name, unit.other_name)) return unit.unit;
  return {};
}

StatedUnit unit_of_centimetres(double centimetres) {
  for (const NamedUnit& unit : kUnits)
    if (std::abs(centimetres - unit.centimetres) <= 1e-6 * unit.centimetres) return unit.unit;
  return {};
}

std::string scene_format(const Input& input) {
  struct Mark {
    std::string_view begin, format;
    std::size_t at = 0;
  };
  constexpr Mark kMarks[] = {{"glTF", "glb"},  {"Kaydara FBX Binary", "fbx"},
                             {"; FBX", "fbx"}, {"xof ", "x"},
                             {"AC3D", "ac"},   {"LWO", "lwo", 8}};
  constexpr Mark kElements[] = {{"<COLLADA", "dae"}, {"<X3D", "x3d"}, {"<amf", "amf"}};
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view content = input.content;
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  for (const Mark& mark : kMarks)
    if (content.size() > mark.at && content.substr(mark.at).starts_with(mark.begin))
      return std::string(mark.format);
  content = content.substr(0, 4096);
  content.remove_prefix(std::min(content.find_first_not_of(" \t\r\n"), content.size()));
  if (content.starts_with('{')) return "gltf";
  for (const Mark& mark : kElements)
    if (content.starts_with('<') && content.find(mark.begin) != content.npos)
      return std::string(mark.format);
  std::string extension = input.path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (content.starts_with("MM")) return extension == "prj" ? extension : "3ds";
  for (const char* own : {"", "stl", "ply", "obj", "off", "3mf"})
    if (extension == own)
      refuse(ErrorCode::kNotAMesh, "",
             "the content is in no format that ist-import reads; convert the mesh to STL, PLY or "
             "OBJ");
  return extension;
}

Eigen::Affine3d root_turn(std::string_view format) {
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  // assimp turns z, which is up in them, to y. An STL of the same scene keeps z.
  if (format == "3ds" || format == "prj" || format == "ase" || format == "dxf")
    turn.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

void tell_unit(std::string_view format, const Input& input, const aiScene& scene,
               PlacedPolygons& placed) {
  StatedUnit stated;
  // The standards of glTF and X3D say metres. assimp converts a COLLADA to metres, with y up.
  if (format == "glb" || format == "gltf" || format == "dae" || format == "x3d")
    stated.unit = LengthUnit::kMetre;
  if (format == "amf") stated = unit_of_amf(input.content);
  float centimetres = 0;
  if (format == "fbx" && scene.mMetaData != nullptr &&
      scene.mMetaData->Get("UnitScaleFactor", centimetres))
    stated = unit_of_centimetres(double{centimetres});
  placed.unit = stated.unit;
  placed.factor = stated.factor;
}

}  // namespace ist::import
