#include "ist/mesh/format/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace ist {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames = {{{"char", PlyType::kInt8},
                                                  {"int8", PlyType::kInt8},
                                                  {"uchar", PlyType::kUint8},
                                                  {"uint8", PlyType::kUint8},
                                                  {"short", PlyType::kInt16},
                                                  {"int16", PlyType::kInt16},
                                                  {"ushort", PlyType::kUint16},
                                                  {"uint16", PlyType::kUint16},
                                                  {"int", PlyType::kInt32},
                                                  {"int32", PlyType::kInt32},
                                                  {"uint", PlyType::kUint32},
                                                  {"uint32", PlyType::kUint32},
                                                  {"float", PlyType::kFloat32},
                                                  {"float32", PlyType::kFloat32},
                                                  {"double", PlyType::kFloat64},
                                                  {"float64", PlyType::kFloat64}}};

PlyType read_type(TextReader& reader) {
  const std::string_view name = reader.word();
  for (const TypeName& known : kTypeNames)
    if (known.name == name) return known.type;
  reader.fail_malformed(
      fmt::format("'{}' is no type of a PLY property; export the mesh again", name.substr(0, 40)));
}

PlyEncoding read_encoding(TextReader& reader) {
  const std::string_view encoding = reader.word();
  if (encoding == "ascii") return PlyEncoding::kText;
  if (encoding == "binary_little_endian") return PlyEncoding::kLittleEndian;
  if (encoding == "binary_big_endian") return PlyEncoding::kBigEndian;
  reader.fail_malformed(
      fmt::format("'{}' is no encoding of a PLY; export the mesh again", encoding.substr(0, 40)));
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
  if (element == "face" && (property == "vertex_indices" || property == "vertex_index"))
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
    // Blender 2.7 leaves out the element 'face' where there is none, but not its list.
    reader.fail(ErrorCode::kMeshPointsOnly,
                "the corners of faces are declared, but no element 'face'; export the surface as "
                "polygons");
  property.role = role_of(element, name);
  const bool list_expected = property.role == PlyRole::kCorners;
  const bool right = property.count_type.has_value() == list_expected &&
                     (!list_expected || is_integer(property.type));
  if (property.role != PlyRole::kOther && !right)
    reader.fail(ErrorCode::kNotAMesh,
                fmt::format("the property '{}' is not {}; export the mesh again", name,
                            list_expected ? "a list of integers" : "one number"));
  if (property.count_type && !is_integer(*property.count_type))
    reader.fail(ErrorCode::kNotAMesh,
                "the length of a list is declared as no integer; export the mesh again");
  return property;
}

std::size_t roles(const PlyElement& element, PlyRole role) {
  return static_cast<std::size_t>(
      std::count_if(element.properties.begin(), element.properties.end(),
                    [role](const PlyProperty& property) { return property.role == role; }));
}

void check_elements(const TextReader& reader, const PlyHeader& header) {
  std::size_t vertex_elements = 0, face_elements = 0;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      ++vertex_elements;
      for (const PlyRole role : {PlyRole::kX, PlyRole::kY, PlyRole::kZ})
        if (element.count > 0 && roles(element, role) != 1)
          reader.fail(ErrorCode::kNotAMesh,
                      "a vertex does not have one each of x, y and z; export the mesh again");
    } else if (element.name == "face") {
      ++face_elements;
      if (element.count > 0 && roles(element, PlyRole::kCorners) != 1)
        reader.fail(ErrorCode::kNotAMesh,
                    "a face does not have one list 'vertex_indices'; export the mesh again");
    } else if (element.name == "tristrips" && element.count > 0) {
      reader.fail(ErrorCode::kNotAMesh,
                  "its surface is in triangle strips, which are not read; export it as faces");
    }
  }
  if (vertex_elements > 1 || face_elements > 1)
    reader.fail(ErrorCode::kNotAMesh,
                "an element is declared more than once; export the mesh again");
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

bool is_integer(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

PlyHeader read_ply_header(TextReader& reader) {
  PlyHeader header;
  bool encoding_seen = false;
  for (bool first = true; reader.next_line(); first = false) {
    const std::string_view word = reader.word();
    if (first && word == "ply") continue;
    if (word == "comment" || word == "obj_info") continue;
    if (word == "end_header") {
      if (!encoding_seen) reader.fail(ErrorCode::kNotAMesh, "the header names no encoding");
      check_elements(reader, header);
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
      reader.fail_malformed(
          fmt::format("'{}' is not expected in the header of a PLY; export the "
                      "mesh again",
                      word.substr(0, 40)));
    }
  }
  reader.fail(ErrorCode::kMeshTruncated,
              "the file ends within its header; copy or export it again");
}

}  // namespace ist
