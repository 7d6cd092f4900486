#include "answers/formats/ply_writer.h"

#include <fmt/format.h>

#include <cctype>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "answers/formats/little_endian.h"
#include "ist/base/assert.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/format/frame_tags.h"

namespace ist::answers {
namespace {

// Properties that lie side by side, for each vertex.
struct Columns {
  std::span<const std::byte> bytes;
  std::size_t width;  // of one vertex, bytes
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  return text;
}

std::string comments_of(const std::vector<NamedText>& texts) {
  std::string comments;
  for (const auto& [name, text] : texts) {
    comments += "comment " + lower(name) + ": " + one_line(text) + "\n";
  }
  return comments;
}

std::string component_name(const DataArray& array, std::size_t component) {
  if (array.components == 1) return lower(array.name);
  const std::string suffix =
      array.components == 3 ? std::string(1, "xyz"[component]) : std::to_string(component);
  return lower(array.name) + "_" + suffix;
}

class VertexElement {
 public:
  explicit VertexElement(std::size_t count)
      : count_(count), header_(fmt::format("element vertex {}\n", count)) {}

  void add(const char* kind, const std::string& name) {
    header_ += fmt::format("property {} {}\n", kind, name);
  }
  // The bytes of the properties that were added last.
  void add_bytes(std::span<const std::byte> bytes) {
    if (count_ > 0) columns_.push_back({bytes, bytes.size() / count_});
  }
  [[nodiscard]] const std::string& header() const { return header_; }

  [[nodiscard]] std::string rows() const {
    std::size_t width = 0;
    for (const Columns& columns : columns_) width += columns.width;
    std::string rows(count_ * width, '\0');
    char* at = rows.data();
    for (std::size_t i = 0; i < count_; ++i) {
      for (const Columns& columns : columns_) {
        std::memcpy(at, columns.bytes.data() + i * columns.width, columns.width);
        at += columns.width;
      }
    }
    return rows;
  }

 private:
  std::size_t count_;
  std::string header_;
  std::vector<Columns> columns_;
};

std::string face_rows(const PolyData& data) {
  std::string rows;
  rows.reserve(data.polygon_count() * (1 + data.corners * sizeof(std::int32_t)));
  for (std::size_t i = 0; i < data.polygons.size(); ++i) {
    if (i % data.corners == 0) append_bytes(rows, static_cast<std::uint8_t>(data.corners));
    append_bytes(rows, static_cast<std::int32_t>(data.polygons[i]));
  }
  return rows;
}

}  // namespace

void write_ply(const PolyData& data, const std::filesystem::path& file,
               const std::string& comment) {
  OutputFile output(file);
  write_ply(data, output, comment);
  output.commit();
}

void write_ply(const PolyData& data, OutputFile& file, const std::string& comment) {
  IST_ASSERT(is_consistent(data));
  if (data.points.size() > std::numeric_limits<std::int32_t>::max()) {
    throw_error(ErrorCode::kFileUnwritable,
                "{}: a PLY's faces know at most 2^31 - 1 points; write a .vtp",
                file.target().string());
  }
  const std::vector<float> points = float_points(data, file.target());
  VertexElement vertices(data.points.size());
  for (const char* name : {"x", "y", "z"}) vertices.add("float", name);
  vertices.add_bytes(std::as_bytes(std::span(points)));
  if (!data.normals.empty()) {
    for (const char* name : {"nx", "ny", "nz"}) vertices.add("float", name);
    vertices.add_bytes(std::as_bytes(std::span(data.normals)));
  }
  if (!data.colours.empty()) {
    for (const char* name : {"red", "green", "blue"}) vertices.add("uchar", name);
    vertices.add_bytes(std::as_bytes(std::span(data.colours)));
  }
  for (const DataArray& array : data.point_arrays) {
    for (std::size_t i = 0; i < array.components; ++i) {
      vertices.add(kind_of(array.numbers, "float", "int", "uchar"), component_name(array, i));
    }
    vertices.add_bytes(bytes_of(array.numbers));
  }
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment " + one_line(comment) + "\n";
  if (data.frame != PatientFrame::kUnknown) {
    header += fmt::format("comment SPACE={}\n", slicer_name(data.frame));
  }
  header += comments_of(data.texts) + vertices.header();
  if (!data.polygons.empty()) {
    header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                          data.polygon_count());
  }
  header += "end_header\n";

  for (const std::string& part : {header, vertices.rows(), face_rows(data)}) {
    file.write(part.data(), part.size());
  }
}

}  // namespace ist::answers
