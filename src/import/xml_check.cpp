#include "import/xml_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <string>

#include "import/placed_polygons.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::import {
namespace {

std::size_t count_of(std::string_view text, std::string_view content) {
  std::size_t count = 0;
  for (std::size_t at = content.find(text); at != content.npos; at = content.find(text, at + 1))
    ++count;
  return count;
}

// assimp turns no instance of a constellation, reads one volume of an object, and takes any word
// for a number.
void check_amf(std::string_view content) {
  if (content.find("<constellation") != content.npos)
    refuse(ErrorCode::kNotAMesh, "",
           "a constellation places its objects, which is not supported; export them in place");
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

// assimp ignores ccw, and makes triangles of lines and points.
void check_x3d(std::string_view content) {
  for (const std::string_view clockwise : {"ccw=\"false\"", "ccw='false'"})
    if (content.find(clockwise) != content.npos)
      refuse(ErrorCode::kNotAMesh, "",
             "its faces run clockwise (ccw=false), which is not supported; export them "
             "counterclockwise");
  for (const std::string_view other : {"LineSet", "PointSet"})
    if (content.find(other) != content.npos)
      refuse(ErrorCode::kNotAMesh, "",
             "it holds lines or points, which are taken for triangles; export the surface alone");
}

}  // namespace

void check_xml(std::string_view format, std::string_view content) {
  if (format == "x3d") check_x3d(content);
  if (format == "amf") check_amf(content);
  if (format == "dae") check_collada(content);
}

}  // namespace ist::import
