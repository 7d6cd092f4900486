#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "ist/base/counted.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// A keyword tells which numbers follow the coordinates of a vertex: normals (N), colours (C) and
// texture coordinates (ST). Other keywords change the number of coordinates.
struct OffKind {
  std::string_view keyword;
  int extras;
};
constexpr std::array<OffKind, 8> kOffKinds = {{{"OFF", 0},
                                               {"COFF", 4},
                                               {"NOFF", 3},
                                               {"CNOFF", 7},
                                               {"STOFF", 2},
                                               {"STCOFF", 6},
                                               {"STNOFF", 5},
                                               {"STCNOFF", 9}}};

// By lines: a line holds one vertex or face, and more words on the line are skipped.
// Free: line ends are blanks, and no word is skipped.
struct OffLayout {
  bool vertices_by_lines, faces_by_lines;
};

struct OffHeader {
  OffKind kind = kOffKinds[0];
  std::int64_t vertices = 0, faces = 0;
};

// Reads the body of an OFF in one layout. The first fault ends it.
class OffBody {
 public:
  OffBody(const TextReader& behind_counts, const OffHeader& header, OffLayout layout)
      : reader_(behind_counts), header_(header), layout_(layout) {
    // The header may claim any counts: nothing is reserved for them.
    read_edges();
    for (std::int64_t i = 0; i < header.vertices && !fault_; ++i) read_vertex();
    by_lines_ = layout.faces_by_lines;
    if (by_lines_ && !fault_ && !at_line_end()) {
      faces_seem_free_ = true;
      fail("words follow the last vertex on its line; export the mesh again");
    }
    for (std::int64_t i = 0; i < header.faces && !fault_; ++i) read_face();
    if (!fault_ && (next_line() || !at_line_end()))
      fail("the file has more lines than the header counts; export the mesh again");
  }

  bool fits() const { return !fault_; }
  // Whether words at the ends of lines were skipped.
  bool skipped() const { return skipped_; }
  // Whether faces do not seem to have a line each: the first one has more or less than a line.
  bool faces_seem_free() const { return faces_seem_free_; }
  const IndexedFaces& surface() const { return surface_; }
  // Throws the fault.
  void require_fit() const {
    if (fault_) fault_();
  }

 private:
  bool at_line_end() const {
    TextReader ahead = reader_;
    return ahead.word_before_comment().empty();
  }
  // Advances to the next line that is not only a comment.
  bool next_line() {
    while (at_line_end()) {
      if (!reader_.next_line()) return false;
    }
    return true;
  }
  void begin(std::string_view element) {
    if (next_line()) return;
    fault_ = [reader = reader_, element] {
      reader.fail(ErrorCode::kMeshTruncated,
                  fmt::format("the file ends before a {}; copy or export it again", element));
    };
  }
  std::string_view word() {
    if (!by_lines_) next_line();
    return reader_.word_before_comment();
  }
  void end() {
    if (!by_lines_) return;
    skipped_ = skipped_ || !at_line_end();
    reader_.skip_line();
  }
  void fail(std::string_view cause) {
    fault_ = [reader = reader_, cause] { reader.fail(ErrorCode::kNotAMesh, cause); };
  }

  // A third count, of edges, follows. It may be missing at the end of a line.
  void read_edges() {
    by_lines_ = layout_.vertices_by_lines;
    if (!by_lines_ || !at_line_end()) static_cast<void>(integer());
    if (by_lines_ && !fault_ && !at_line_end())
      fail("words follow the counts; export the mesh again");
  }

  void read_vertex() {
    begin("vertex");
    Eigen::Vector3d vertex;
    for (double& coordinate : vertex) {
      if (fault_) return;
      const std::string_view spelled = word();
      const std::optional<double> number = number_of(spelled, Precision::kDouble);
      if (number && is_coordinate(*number)) {
        coordinate = *number;
      } else {
        fault_ = [reader = reader_, spelled] {
          static_cast<void>(reader.coordinate(spelled, Precision::kDouble));
        };
      }
    }
    for (int i = 0; i < header_.kind.extras && !by_lines_; ++i) static_cast<void>(word());
    surface_.add_vertex(vertex);
    end();
  }

  void read_face() {
    begin("face");
    const std::int64_t corners = fault_ ? 0 : integer();
    if (!fault_ && (corners < 3 || corners > kMaxCorners))
      fault_ = [reader = reader_, corners] { require_face_size(corners, reader); };
    corners_.clear();
    for (std::int64_t i = 0; i < corners && !fault_; ++i) {
      if (surface_.faces() == 0 && at_line_end()) faces_seem_free_ = true;
      corners_.push_back(read_corner());
    }
    if (fault_) return;
    surface_.add_face(corners_);
    end();
  }

  std::uint32_t read_corner() {
    const std::int64_t corner = integer();
    const auto vertices = static_cast<std::int64_t>(surface_.vertices());
    if (!fault_ && (corner < 0 || corner >= vertices))
      fault_ = [reader = reader_, corner, vertices] {
        reader.fail(ErrorCode::kMeshBadIndex,
                    fmt::format("a face names vertex {}, but there are {}, counted from 0; export "
                                "the mesh again",
                                corner, vertices));
      };
    return static_cast<std::uint32_t>(corner);
  }

  std::int64_t integer() {
    const std::string_view spelled = word();
    const std::optional<std::int64_t> value = TextReader::whole(spelled);
    if (!value)
      fault_ = [reader = reader_, spelled] { static_cast<void>(reader.integer(spelled)); };
    return value.value_or(0);
  }

  TextReader reader_;
  const OffHeader& header_;
  OffLayout layout_;
  bool by_lines_ = false;
  bool skipped_ = false, faces_seem_free_ = false;
  std::function<void()> fault_;
  IndexedFaces surface_;
  std::vector<std::uint32_t> corners_;
};

class OffReader {
 public:
  OffReader(std::string_view content, std::string_view file)
      : reader_(content, file), file_(file) {}

  TriangleMesh read() {
    read_header();
    const IndexedFaces surface = read_body();
    if (surface.faces() == 0 && surface.vertices() == 0)
      fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the OFF has no vertex; export the mesh again");
    if (surface.faces() == 0)
      fail_mesh(ErrorCode::kMeshPointsOnly, file_, "",
                fmt::format("the file has {}, but no face; export the surface as polygons",
                            counted(surface.vertices(), "vertex", "vertices")));
    return surface.weld();
  }

 private:
  std::string_view word() {
    std::string_view found = reader_.word_before_comment();
    while (found.empty() && reader_.next_line()) found = reader_.word_before_comment();
    return found;
  }

  // The keyword may be missing, and a count may be glued to it: OFF8 6 12.
  void read_header() {
    std::string_view first = word();
    if (!TextReader::whole(first)) {
      const std::string_view keyword = first.substr(0, first.rfind("OFF") + 3);
      const auto known = std::find_if(kOffKinds.begin(), kOffKinds.end(),
                                      [&](const OffKind& kind) { return kind.keyword == keyword; });
      if (known == kOffKinds.end())
        reader_.fail(ErrorCode::kNotAMesh,
                     fmt::format("an OFF of kind '{}' is not supported; export it as plain OFF",
                                 printable(keyword)));
      header_.kind = *known;
      first.remove_prefix(keyword.size());
      if (first.empty()) first = word();
    }
    if (first == "BINARY")
      reader_.fail(ErrorCode::kNotAMesh, "a binary OFF is not supported; export it as text");
    header_.vertices = count(first);
    header_.faces = count(word());
  }

  std::int64_t count(std::string_view spelled) const {
    const std::int64_t named = reader_.integer(spelled);
    if (named < 0)
      reader_.fail(ErrorCode::kNotAMesh,
                   fmt::format("the header counts {} elements; export the mesh again", named));
    return named;
  }

  // If words were skipped, the file is read in each layout. Layouts that fit must agree.
  IndexedFaces read_body() const {
    OffBody plain = body(true, true);
    if (plain.fits() && !plain.skipped()) return plain.surface();
    std::optional<IndexedFaces> found;
    for (const auto [vertices, faces] :
         {OffLayout{true, true}, {true, false}, {false, true}, {false, false}}) {
      const OffBody read = body(vertices, faces);
      if (!read.fits()) continue;
      if (found && !(*found == read.surface()))
        fail_mesh(
            ErrorCode::kNotAMesh, file_, "",
            "numbers at the ends of lines could be colours, or vertices and faces; export the "
            "mesh as plain OFF, without colours");
      found = read.surface();
    }
    if (found) return *std::move(found);
    // The likely layout has the most helpful error.
    const bool by_lines = begins_by_lines();
    const OffBody likely = body(by_lines, true);
    body(by_lines, !likely.faces_seem_free()).require_fit();
    likely.require_fit();
    return {};
  }

  OffBody body(bool vertices_by_lines, bool faces_by_lines) const {
    return {reader_, header_, {vertices_by_lines, faces_by_lines}};
  }

  // Whether the lines of the counts and of the first vertex hold as many words as they may.
  bool begins_by_lines() const {
    constexpr int kMostWords = 12;  // coordinates, normal, colour and texture coordinates
    TextReader ahead = reader_;
    static_cast<void>(ahead.word_before_comment());
    if (!ahead.word_before_comment().empty()) return false;
    int words = 0;
    while (words == 0 && ahead.next_line()) {
      while (!ahead.word_before_comment().empty()) ++words;
    }
    return words == 0 || (words >= 3 && words <= kMostWords);
  }

  TextReader reader_;
  std::string_view file_;
  OffHeader header_;
};

}  // namespace

TriangleMesh read_off(std::string_view content, std::string_view file) {
  return OffReader(content, file).read();
}

}  // namespace ist
