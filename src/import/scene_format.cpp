#include "import/scene_format.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "ist/base/printable.h"
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

std::size_t count_of(std::string_view text, std::string_view content) {
  std::size_t count = 0;
  for (std::size_t at = content.find(text); at != content.npos; at = content.find(text, at + 1))
    ++count;
  return count;
}

// assimp reads one volume of an object, and takes any word for a number.
void check_amf(std::string_view content) {
  if (count_of("<volume", content) > count_of("<mesh", content))
    refuse(ErrorCode::kNotAMesh, "",
           "an object has several volumes, which is not supported; export them as one");
  for (const std::string_view tag : {"<x>", "<y>", "<z>"}) {
    for (std::size_t at = content.find(tag); at != content.npos; at = content.find(tag, at + 1)) {
      TextReader word(content.substr(at + tag.size(), content.find('<', at + 1) - at - tag.size()),
                      "");
      const std::string_view number = word.word_of_any_line();
      if (!number_of(number, Precision::kDouble))
        refuse(ErrorCode::kNotAMesh, "",
               fmt::format("'{}' is no number; export the mesh again", printable(number)));
    }
  }
}

// Whether a node is placed by a transform that assimp reads otherwise, and holds a surface.
bool is_placed_oddly(const pugi::xml_node& node, bool oddly) {
  oddly = oddly || node.child("lookat") || node.child("skew");
  if (oddly && (node.child("instance_geometry") || node.child("instance_node"))) return true;
  const auto nodes = node.children("node");
  return std::any_of(nodes.begin(), nodes.end(), [oddly](const pugi::xml_node& child) {
    return is_placed_oddly(child, oddly);
  });
}

// assimp ends a number at a comma, and takes a negative index for another one.
void check_collada(std::string_view content) {
  pugi::xml_document document;
  if (!document.load_buffer(content.data(), content.size()))
    refuse(ErrorCode::kNotAMesh, "", "it is no XML; copy or export the mesh again");
  const pugi::xml_node root = document.document_element();
  for (const pugi::xpath_node& found : root.select_nodes("//float_array"))
    if (std::string_view(found.node().text().get()).find(',') != std::string_view::npos)
      refuse(ErrorCode::kNotAMesh, "",
             "its numbers have decimal commas; export the mesh again with decimal points");
  for (const pugi::xpath_node& found : root.select_nodes("//p"))
    if (std::string_view(found.node().text().get()).find('-') != std::string_view::npos)
      refuse(ErrorCode::kMeshBadIndex, "", "an index is negative; export the mesh again");
  for (const pugi::xpath_node& found : root.select_nodes("//visual_scene | //library_nodes"))
    if (is_placed_oddly(found.node(), false))
      refuse(ErrorCode::kNotAMesh, "",
             "a node is placed by <lookat> or <skew>, which is not supported; apply it before you "
             "export the mesh");
}

// The attribute of the root of an AMF. Its standard takes millimetres if there is none.
StatedUnit unit_of_amf(std::string_view content) {
  const std::string_view begin = content.substr(content.find("<amf"));
  pugi::xml_document
      root;  // of one open tag: an error for the parser, which keeps what it has read
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
  constexpr Mark kMarks[] = {{"glTF", "glb"},  {"BLENDER", "blend"}, {"Kaydara FBX Binary", "fbx"},
                             {"; FBX", "fbx"}, {"xof ", "x"},        {"AC3D", "ac"},
                             {"LWO", "lwo", 8}};
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

void check_scene(std::string_view format, const Input& input) {
  constexpr std::string_view kWinding = "ccw=";
  const std::string_view content = input.content;
  const auto holds = [content](std::string_view text) {
    return content.find(text) != content.npos;
  };
  for (std::size_t at = content.find(kWinding); format == "x3d" && at != content.npos;
       at = content.find(kWinding, at + 1)) {
    if (same_word(content.substr(at + kWinding.size()).substr(0, 6), "\"false") ||
        same_word(content.substr(at + kWinding.size()).substr(0, 6), "'false"))
      refuse(ErrorCode::kNotAMesh, "",
             "its faces run clockwise (ccw=false), which is not supported; export them "
             "counterclockwise");
  }
  if (format == "x3d" && (holds("LineSet") || holds("PointSet")))
    refuse(ErrorCode::kNotAMesh, "",
           "it holds lines or points, which are taken for triangles; export the surface alone");
  if (format == "amf" && holds("<constellation"))
    refuse(ErrorCode::kNotAMesh, "",
           "a constellation places its objects, which is not supported; export them in place");
  if (format == "amf") check_amf(content);
  if (format == "dae") check_collada(content);
  if (format == "blend")
    refuse(ErrorCode::kNotAMesh, "",
           "files of Blender are read in part; export the mesh as PLY, STL or glTF in Blender");
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
