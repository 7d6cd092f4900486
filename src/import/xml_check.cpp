#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "import/format_checks.h"
#include "import/placed_polygons.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::import {
namespace {

[[noreturn]] void refuse_xml(std::string_view cause) { refuse(ErrorCode::kNotAMesh, "", cause); }

double number_in(std::string_view text) {
  TextReader words(text, "");  // blanks may stand round it
  const std::string_view word = words.word_of_any_line();
  const std::optional<double> number = number_of(word, Precision::kDouble);
  if (!number) refuse_xml(fmt::format("'{}' is no number; export the mesh again", printable(word)));
  return *number;
}

// assimp turns no instance of a constellation, reads one volume of an object, and takes any word
// for a number. The standard says millimetres if the root names no unit.
StatedUnit check_amf(const pugi::xml_node& root) {
  if (root.select_node("//constellation"))
    refuse_xml("a constellation places its objects, which is not supported; export them in place");
  for (const pugi::xpath_node& volume : root.select_nodes("//volume"))
    if (volume.node().next_sibling("volume"))
      refuse_xml("an object has several volumes, which is not supported; export them as one");
  for (const pugi::xpath_node& point : root.select_nodes("//coordinates"))
    for (const pugi::xml_node& coordinate : point.node().children())
      static_cast<void>(number_in(coordinate.text().get()));
  return unit_of_name(root.attribute("unit").as_string("millimeter"));
}

// Returns whether a node with a surface is placed by <lookat> or <skew>.
bool is_placed_oddly(const pugi::xml_node& node, bool oddly) {
  oddly = oddly || node.child("lookat") || node.child("skew");
  if (oddly && (node.child("instance_geometry") || node.child("instance_node"))) return true;
  const auto nodes = node.children("node");
  return std::any_of(nodes.begin(), nodes.end(), [oddly](const pugi::xml_node& child) {
    return is_placed_oddly(child, oddly);
  });
}

// assimp ends a number at a comma, takes a negative index for another one, shears by <lookat> and
// ignores <skew>.
void check_collada(const pugi::xml_node& root) {
  for (const pugi::xpath_node& found : root.select_nodes("//float_array"))
    if (std::string_view(found.node().text().get()).find(',') != std::string_view::npos)
      refuse_xml("its numbers have decimal commas; export the mesh again with decimal points");
  for (const pugi::xpath_node& found : root.select_nodes("//p"))
    if (std::string_view(found.node().text().get()).find('-') != std::string_view::npos)
      refuse(ErrorCode::kMeshBadIndex, "", "an index is negative; export the mesh again");
  for (const pugi::xpath_node& found : root.select_nodes("//visual_scene | //library_nodes"))
    if (is_placed_oddly(found.node(), false))
      refuse_xml(
          "a node is placed by <lookat> or <skew>, which is not supported; apply it before you "
          "export the mesh");
}

// assimp ignores ccw and units, makes triangles of lines and points, and passes over groups that it
// does not know.
StatedUnit check_x3d(const pugi::xml_node& root) {
  StatedUnit stated{LengthUnit::kMetre, 1};
  int units = 0;
  for (const pugi::xpath_node& found : root.select_nodes("//unit")) {
    const std::string_view category = found.node().attribute("category").value();
    const double factor = number_in(found.node().attribute("conversionFactor").as_string("1"));
    if (category == "angle" && factor != 1)
      refuse_xml("its angles are no radians, which is not supported; export the mesh again");
    if (category != "length") continue;
    if (++units > 1 || found.node().parent().parent() != root || !(factor > 0 && factor < 1e30))
      refuse_xml(
          "its head does not state one length unit of a positive factor; export the mesh again in "
          "metres");
    stated.factor = factor;
  }
  for (const pugi::xpath_node& found : root.select_nodes("//*")) {
    const std::string_view name = found.node().name();
    if (same_word(found.node().attribute("ccw").value(), "false"))
      refuse_xml(
          "its faces run clockwise (ccw=false), which is not supported; export them "
          "counterclockwise");
    if (name.ends_with("LineSet") || name.ends_with("PointSet"))
      refuse_xml(
          "it holds lines or points, which are taken for triangles; export the surface alone");
    if (name != "Shape") continue;
    constexpr std::string_view kGroups[] = {"Group", "StaticGroup", "Transform", "Switch", "Scene"};
    for (pugi::xml_node group = found.node().parent(); group != root; group = group.parent())
      if (std::find(std::begin(kGroups), std::end(kGroups), group.name()) == std::end(kGroups))
        refuse_xml(fmt::format("a shape lies in <{}>, which is not supported; export it without",
                               printable(group.name())));
  }
  return stated;
}

}  // namespace

StatedUnit check_xml(std::string_view format, std::string_view content) {
  if (format != "x3d" && format != "amf" && format != "dae") return {};
  pugi::xml_document document;
  if (!document.load_buffer(content.data(), content.size()))
    refuse_xml("it is no XML; copy or export the mesh again");
  const pugi::xml_node root = document.document_element();
  if (format == "x3d") return check_x3d(root);
  if (format == "amf") return check_amf(root);
  check_collada(root);
  return {};
}

}  // namespace ist::import
