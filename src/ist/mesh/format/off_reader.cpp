#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// With texture coordinates (ST), colours (C) and normals (N). Others have no three coordinates.
constexpr std::array<std::string_view, 8> kKeywords = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                       "STOFF", "STCOFF", "STNOFF", "STCNOFF"};

// Reads one line for each vertex and each face; colours, normals and texture coordinates after them
// are skipped.
class OffReader {
 public:
  OffReader(std::string_view content, std::string_view file)
      : reader_(content, file), file_(file) {}

  TriangleMesh read() {
    next_line("header");
    const std::string_view keyword = reader_.word_before_comment();
    if (std::find(kKeywords.begin(), kKeywords.end(), keyword) == kKeywords.end())
      reader_.fail(ErrorCode::kNotAMesh,
                   fmt::format("an OFF of kind '{}' is not supported; export it as plain OFF",
                               printable(keyword)));
    std::string_view word = reader_.word_before_comment();
    if (word == "BINARY")
      reader_.fail(ErrorCode::kNotAMesh, "a binary OFF is not supported; export it as text");
    if (word.empty()) {
      next_line("header");
      word = reader_.word_before_comment();
    }
    const std::int64_t vertices = count(word);
    const std::int64_t faces = count(reader_.word_before_comment());
    // The header may claim any counts: nothing is reserved for them.
    for (std::int64_t i = 0; i < vertices; ++i) read_vertex();
    for (std::int64_t i = 0; i < faces; ++i) read_face();
    if (next_line())
      reader_.fail(ErrorCode::kNotAMesh,
                   "the file has more lines than the header counts; export the mesh again");
    if (faces == 0 && vertices == 0)
      fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the OFF has no vertex; export the mesh again");
    if (faces == 0)
      fail_mesh(ErrorCode::kMeshPointsOnly, file_, "",
                fmt::format("the file has {} vertices, but no face; export the surface as polygons",
                            vertices));
    return surface_.weld();
  }

 private:
  // Advances to the next line that is not only a comment.
  bool next_line() {
    while (reader_.next_line()) {
      TextReader ahead = reader_;
      if (!ahead.word_before_comment().empty()) return true;
    }
    return false;
  }
  void next_line(std::string_view element) {
    if (!next_line())
      reader_.fail(ErrorCode::kMeshTruncated,
                   fmt::format("the file ends before a {}; copy or export it again", element));
  }

  std::int64_t count(std::string_view word) const {
    const std::int64_t named = reader_.integer(word);
    if (named < 0)
      reader_.fail(ErrorCode::kNotAMesh,
                   fmt::format("the header counts {} elements; export the mesh again", named));
    return named;
  }

  void read_vertex() {
    next_line("vertex");
    Eigen::Vector3d vertex;
    for (double& coordinate : vertex)
      coordinate = reader_.coordinate(reader_.word_before_comment(), Precision::kDouble);
    surface_.add_vertex(vertex);
  }

  void read_face() {
    next_line("face");
    const std::int64_t corners = reader_.integer(reader_.word_before_comment());
    require_face_size(corners, reader_);
    corners_.clear();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t corner = reader_.integer(reader_.word_before_comment());
      if (corner < 0 || corner >= static_cast<std::int64_t>(surface_.vertices()))
        reader_.fail(ErrorCode::kMeshBadIndex,
                     fmt::format("a face names vertex {}, but there are {}, counted from 0; export "
                                 "the mesh again",
                                 corner, surface_.vertices()));
      corners_.push_back(static_cast<std::uint32_t>(corner));
    }
    surface_.add_face(corners_);
  }

  TextReader reader_;
  std::string_view file_;
  IndexedFaces surface_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

TriangleMesh read_off(std::string_view content, std::string_view file) {
  return OffReader(content, file).read();
}

}  // namespace ist
