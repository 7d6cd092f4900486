#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "ist/base/counted.h"
#include "ist/mesh/format/frame_tags.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view content, std::string_view file)
      : reader_(content, file, TextReader::LineEnd::kObj), file_(file), tags_(file) {}

  TriangleMesh read() {
    bool statement_seen = false;
    bool other_seen = false;
    while (reader_.next_line()) {
      if (reader_.rest().starts_with('#')) tags_.read(reader_.rest());
      const std::string_view statement = reader_.word_before_comment();
      if (statement == "v") {
        read_vertex();
      } else if (statement == "f") {
        read_face();
      } else if (!statement.empty()) {
        (is_obj_statement(statement) ? statement_seen : other_seen) = true;
      }
    }
    if (highest_ > static_cast<std::int64_t>(surface_.vertices()))
      bad_index(highest_, highest_line_);
    if (surface_.faces() == 0) fail_without_faces(statement_seen, other_seen);
    TriangleMesh mesh = surface_.weld();
    mesh.frame = tags_.frame();
    return mesh;
  }

 private:
  // Ignores a weight or a colour after the three coordinates.
  void read_vertex() {
    Eigen::Vector3d vertex;
    for (double& coordinate : vertex)
      coordinate = reader_.coordinate(reader_.word_before_comment(), Precision::kDouble);
    surface_.add_vertex(vertex);
  }

  void read_face() {
    corners_.clear();
    for (std::string_view corner = reader_.word_before_comment(); !corner.empty();
         corner = reader_.word_before_comment())
      corners_.push_back(read_corner(corner.substr(0, corner.find('/'))));
    if (corners_.size() < 3)
      reader_.fail_malformed(fmt::format(
          "a face has {} corners, and needs three; export the mesh again", corners_.size()));
    require_face_size(static_cast<std::int64_t>(corners_.size()), reader_);
    surface_.add_face(corners_);
  }

  // Indices count from 1, or backwards from the last vertex so far, which is -1. A vertex may
  // follow the face.
  std::uint32_t read_corner(std::string_view digits) {
    const std::int64_t named = reader_.integer(digits);
    const auto so_far = static_cast<std::int64_t>(surface_.vertices());
    const std::int64_t index = named < 0 ? so_far + named : named - 1;
    if (named == 0 || index < 0 || index >= std::numeric_limits<std::int32_t>::max())
      bad_index(named, reader_.line_number());
    if (named > highest_) {
      highest_ = named;
      highest_line_ = reader_.line_number();
    }
    return static_cast<std::uint32_t>(index);
  }

  [[noreturn]] void bad_index(std::int64_t named, std::size_t line) const {
    fail_mesh(
        ErrorCode::kMeshBadIndex, file_, fmt::format("line {}", line),
        fmt::format("a face names vertex {}, which does not exist; export the mesh again", named));
  }

  [[noreturn]] void fail_without_faces(bool statement_seen, bool other_seen) const {
    if (surface_.vertices() > 0)
      fail_mesh(ErrorCode::kMeshPointsOnly, file_, "",
                fmt::format("the file has {}, but no face; export the surface as polygons",
                            counted(surface_.vertices(), "vertex", "vertices")));
    if (other_seen && !statement_seen)
      fail_mesh(ErrorCode::kNotAMesh, file_, "",
                "the name ends in .obj, but no line is an OBJ statement; export the mesh again");
    fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the OBJ has no vertex; export the mesh again");
  }

  TextReader reader_;
  std::string_view file_;
  FrameTags tags_;
  IndexedFaces surface_;
  std::vector<std::uint32_t> corners_;
  std::int64_t highest_ = 0;      // the highest index in a face
  std::size_t highest_line_ = 0;  // the line of that face
};

}  // namespace

bool is_obj_statement(std::string_view word) {
  constexpr std::array<std::string_view, 12> kStatements = {
      "v", "vt", "vn", "vp", "f", "l", "p", "o", "g", "s", "usemtl", "mtllib"};
  return std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
}

TriangleMesh read_obj(std::string_view content, std::string_view file) {
  return ObjReader(content, file).read();
}

}  // namespace ist
