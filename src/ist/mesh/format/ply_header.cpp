#include "ist/mesh/format/ply_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "ist/base/printable.h"
#include "ist/mesh/format/frame_tags.h"

namespace ist {
namespace {

constexpr PlyType kPlyTypes[] = {
    number_type<std::int8_t>("char"),     number_type<std::int8_t>("int8"),
    number_type<std::uint8_t>("uchar"),   number_type<std::uint8_t>("uint8"),
    number_type<std::int16_t>("short"),   number_type<std::int16_t>("int16"),
    number_type<std::uint16_t>("ushort"), number_type<std::uint16_t>("uint16"),
    number_type<std::int32_t>("int"),     number_type<std::int32_t>("int32"),
    number_type<std::uint32_t>("uint"),   number_type<std::uint32_t>("uint32"),
    number_type<float>("float"),          number_type<float>("float32"),
    number_type<double>("double"),        number_type<double>("float64")};

const PlyType* read_type(TextReader& reader) {
  const std::string_view name = reader.word();
  for (const PlyType& type : kPlyTypes)
    if (type.name == name) return &type;
  reader.fail_malformed(
      fmt::format("'{}' is not a PLY property type; export the mesh again", printable(name)));
}

PlyEncoding read_encoding(TextReader& reader) {
  const std::string_view encoding = reader.word();
  if (encoding == "ascii") return PlyEncoding::kText;
  if (encoding == "binary_little_endian") return PlyEncoding::kLittleEndian;
  if (encoding == "binary_big_endian") return PlyEncoding::kBigEndian;
  reader.fail_malformed(
      fmt::format("'{}' is not a PLY encoding; export the mesh again", printable(encoding)));
}

PlyElement read_element(TextReader& reader) {
  PlyElement element;
  element.name = reader.word();
  const std::int64_t count = reader.integer(reader.word());
  if (count < 0)
    reader.fail(ErrorCode::kNotAMesh,
                fmt::format("the element has a count of {}; export the mesh again", count));
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

PlyRole role_of(std::string_view element, std::string_view property) {
  if (element == "vertex" && property == "x") return PlyRole::kX;
  if (element == "vertex" && property == "y") return PlyRole::kY;
  if (element == "vertex" && property == "z") return PlyRole::kZ;
  if ((element == "face" || element == kPlyStrips) &&
      (property == "vertex_indices" || property == "vertex_index"))
    return PlyRole::kCorners;
  return PlyRole::kOther;
}

PlyProperty read_property(TextReader& reader, std::string_view element) {
  PlyProperty property;
  TextReader ahead = reader;
  if (ahead.word() == "list") {
    reader = ahead;
    property.count_type = read_type(reader);
  }
  property.type = read_type(reader);
  const std::string_view name = reader.word();
  if (name.empty()) reader.fail_malformed("a property has no name; export the mesh again");
  if (element == "vertex" && role_of("face", name) == PlyRole::kCorners)
    // Blender 2.7 omits the element 'face' of a mesh without faces, but not its list.
    reader.fail(ErrorCode::kMeshPointsOnly,
                "the header declares corners of faces, but no element 'face'; export the surface "
                "as polygons");
  property.name = name;
  property.role = role_of(element, name);
  const bool list_expected = property.role == PlyRole::kCorners;
  const bool right = (property.count_type != nullptr) == list_expected &&
                     (!list_expected || property.type->is_integer);
  if (property.role != PlyRole::kOther && !right)
    reader.fail(ErrorCode::kNotAMesh,
                fmt::format("the property '{}' is not {}; export the mesh again", printable(name),
                            list_expected ? "a list of integers" : "one number"));
  if (property.count_type != nullptr && !property.count_type->is_integer)
    reader.fail(ErrorCode::kNotAMesh,
                "the length of a list is not declared as an integer; export the mesh again");
  return property;
}

bool has_one(const PlyElement& element, PlyRole role) {
  return std::count_if(element.properties.begin(), element.properties.end(),
                       [role](const PlyProperty& property) { return property.role == role; }) == 1;
}

void check_elements(const TextReader& reader, const PlyHeader& header) {
  const auto refuse = [&reader](std::string_view cause) {
    reader.fail(ErrorCode::kNotAMesh, cause);
  };
  for (const PlyElement& element : header.elements) {
    if (element.count == 0) continue;
    if (element.name == "vertex" &&
        !(has_one(element, PlyRole::kX) && has_one(element, PlyRole::kY) &&
          has_one(element, PlyRole::kZ)))
      refuse("a vertex does not have one each of x, y and z; export the mesh again");
    if ((element.name == "face" || element.name == kPlyStrips) &&
        !has_one(element, PlyRole::kCorners))
      refuse("a face does not have one list 'vertex_indices'; export the mesh again");
  }
  for (const std::string_view name : {"vertex", "face"})
    if (std::count_if(header.elements.begin(), header.elements.end(),
                      [name](const PlyElement& element) { return element.name == name; }) > 1)
      refuse("an element is declared more than once; export the mesh again");
}

}  // namespace

PlyHeader read_ply_header(TextReader& reader) {
  PlyHeader header;
  FrameTags tags(reader.file());
  bool encoding_seen = false;
  for (bool first = true; reader.next_line(); first = false) {
    const std::string_view word = reader.word();
    if (first && word == "ply") continue;
    if (word == "comment" || word == "obj_info") {
      tags.read(reader.rest());
      continue;
    }
    if (word == "end_header") {
      if (!encoding_seen)
        reader.fail(ErrorCode::kNotAMesh, "the header names no encoding; export the mesh again");
      check_elements(reader, header);
      header.frame = tags.frame();
      return header;
    }
    if (word == "format") {
      header.encoding = read_encoding(reader);
      encoding_seen = true;
    } else if (word == "element") {
      header.elements.push_back(read_element(reader));
    } else if (word == "property" && !header.elements.empty()) {
      PlyElement& element = header.elements.back();
      element.properties.push_back(read_property(reader, element.name));
    } else {
      reader.fail_malformed(fmt::format(
          "'{}' is not expected in the header of a PLY; export the mesh again", printable(word)));
    }
  }
  reader.fail(ErrorCode::kMeshTruncated,
              "the file ends within its header; copy or export it again");
}

}  // namespace ist
