#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "ist/mesh/format/mesh_format.h"
#include "ist/mesh/format/ply_header.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// Reads the values after a text header: one line for each vertex or face.
class TextBody {
 public:
  explicit TextBody(TextReader reader) : reader_(reader) {}

  void begin(const PlyElement& element, std::uint64_t index) {
    if (!reader_.next_line())
      reader_.fail(ErrorCode::kMeshTruncated,
                   fmt::format("the file ends after {} of the {} elements '{}' that its header "
                               "counts; copy or export it again",
                               index, element.count, element.name));
  }
  void end() {
    if (!reader_.word().empty())
      reader_.fail(ErrorCode::kNotAMesh,
                   "the line has more values than the header declares; export the mesh again");
  }
  void finish() {
    if (reader_.next_line())
      reader_.fail(ErrorCode::kNotAMesh,
                   "the file has more elements than the header counts; export the mesh again");
  }
  float coordinate(const PlyType*) { return reader_.coordinate(reader_.word()); }
  std::int64_t integer(const PlyType*) { return reader_.integer(reader_.word()); }
  void skip(const PlyType*) {
    if (reader_.word().empty()) reader_.fail_malformed("a value is missing; export the mesh again");
  }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    reader_.fail(code, cause);
  }

 private:
  TextReader reader_;
};

// Reads the values after a binary header.
class BinaryBody {
 public:
  BinaryBody(std::string_view content, std::size_t offset, bool big_endian, std::string_view file)
      : content_(content), offset_(offset), big_endian_(big_endian), file_(file) {}

  void begin(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  void end() {}
  void finish() const {
    if (content_.find_first_not_of(std::string_view(" \t\r\n\0", 5), offset_) !=
        std::string_view::npos)
      fail_mesh(ErrorCode::kNotAMesh, file_, fmt::format("byte {}", offset_),
                "bytes follow the elements that the header counts; export the mesh again");
  }
  float coordinate(const PlyType* type) {
    const auto value = static_cast<float>(number(type));
    if (!std::isfinite(value))
      fail(ErrorCode::kMeshNotFinite,
           "a coordinate is not finite as a float; repair the mesh where it was made");
    return value;
  }
  std::int64_t integer(const PlyType* type) { return static_cast<std::int64_t>(number(type)); }
  void skip(const PlyType* type) { static_cast<void>(take(type->size)); }
  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    fail_mesh(code, file_, fmt::format("{} {}", element_->name, index_), cause);
  }

 private:
  std::string_view take(std::size_t size) {
    if (content_.size() - offset_ < size)
      fail(ErrorCode::kMeshTruncated,
           fmt::format("the file ends within this element, one of {} that its header counts; copy "
                       "or export it again",
                       element_->count));
    return content_.substr(std::exchange(offset_, offset_ + size), size);
  }

  double number(const PlyType* type) {
    std::array<char, sizeof(double)> raw;
    const std::string_view bytes = take(type->size);
    if (big_endian_) {
      std::reverse_copy(bytes.begin(), bytes.end(), raw.begin());
    } else {
      std::copy(bytes.begin(), bytes.end(), raw.begin());
    }
    return type->number(raw.data());
  }

  std::string_view content_;
  std::size_t offset_;
  bool big_endian_;
  std::string_view file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
};

template <class Body>
void read_corners(Body& body, std::int64_t count, const PlyProperty& property,
                  std::uint64_t vertices, std::vector<std::uint32_t>& corners) {
  if (count < 3)
    body.fail(ErrorCode::kNotAMesh,
              fmt::format("a face has {} corners, and needs three; export the mesh again", count));
  if (count > static_cast<std::int64_t>(kMaxCorners))
    body.fail(ErrorCode::kNotAMesh,
              fmt::format("a face has {} corners, more than {}; triangulate the mesh first", count,
                          kMaxCorners));
  corners.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t corner = body.integer(property.type);
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertices)
      body.fail(ErrorCode::kMeshBadIndex,
                fmt::format("a face names vertex {}, but there are {}, counted from 0; export the "
                            "mesh again",
                            corner, vertices));
    corners.push_back(static_cast<std::uint32_t>(corner));
  }
}

// Reads one vertex, face or other element; keeps coordinates and corners.
template <class Body>
void read_instance(Body& body, const PlyElement& element, std::uint64_t vertices,
                   std::vector<std::uint32_t>& corners, PlyContent& content) {
  std::array<float, 3> vertex{};
  for (const PlyProperty& property : element.properties) {
    if (property.role == PlyRole::kCorners) {
      read_corners(body, body.integer(property.count_type), property, vertices, corners);
    } else if (property.role == PlyRole::kOther) {
      const std::int64_t count = property.count_type ? body.integer(property.count_type) : 1;
      for (std::int64_t i = 0; i < count; ++i) body.skip(property.type);
    } else {
      vertex[static_cast<std::size_t>(property.role)] = body.coordinate(property.type);
    }
  }
  if (element.name == "vertex") content.add_vertex(vertex);
  if (element.name == "face") content.add_face(corners);
}

template <class Body>
CheckedContent read_elements(Body body, const PlyHeader& header, std::string_view file) {
  std::uint64_t vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") vertices = element.count;
  PlyContent content;
  std::vector<std::uint32_t> corners;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;  // takes no bytes in the file, for any count
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.begin(element, i);
      read_instance(body, element, vertices, corners, content);
      body.end();
    }
  }
  body.finish();
  if (content.faces() == 0 && content.vertices() == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file, "", "the PLY has no vertex; export the mesh again");
  if (content.faces() == 0)
    fail_mesh(ErrorCode::kMeshPointsOnly, file, "",
              fmt::format("the file has {} vertices, but no face; export the surface as polygons",
                          content.vertices()));
  return content.finish();
}

}  // namespace

CheckedContent check_ply(std::string_view content, std::string_view file) {
  TextReader reader(content, file);
  const PlyHeader header = read_ply_header(reader);
  if (header.encoding == PlyEncoding::kText) return read_elements(TextBody(reader), header, file);
  const bool big_endian = header.encoding == PlyEncoding::kBigEndian;
  return read_elements(BinaryBody(content, reader.next_line_offset(), big_endian, file), header,
                       file);
}

}  // namespace ist
