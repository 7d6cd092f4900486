#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "ist/base/printable.h"
#include "ist/mesh/format/frame_tags.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// Returns the header's facet count. Precondition: the content holds the header and the count.
std::size_t facet_count(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + kStlHeaderBytes, sizeof count);
  return count;
}

std::size_t whole_facets(std::string_view content) {
  return (content.size() - kStlCountEnd) / kStlFacetBytes;
}

// The nine coordinates of a facet's corners.
using Corners = std::array<float, 9>;

Corners corners_of(std::string_view content, std::size_t facet) {
  Corners corners;
  std::memcpy(corners.data(),
              content.data() + kStlCountEnd + facet * kStlFacetBytes + kStlNormalBytes,
              sizeof corners);
  return corners;
}

bool is_finite(const Corners& corners) {
  return std::all_of(corners.begin(), corners.end(), [](float x) { return std::isfinite(x); });
}

void add_facet(const Corners& corners, MeshBuilder& builder) {
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i)
    triangle[i] = builder.vertex_at({corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]});
  builder.add_face(triangle);
}

class TextStl {
 public:
  TextStl(std::string_view content, std::string_view file)
      : reader_(content, file), file_(file), tags_(file) {}

  TriangleMesh read() {
    std::size_t facets = 0;
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (!same_word(word, "solid")) unexpected(word, "solid");
      tags_.read(reader_.rest());
      reader_.skip_line();  // the name, which may hold any words
      for (word = next(); !same_word(word, "endsolid"); word = next(), ++facets) {
        if (!same_word(word, "facet")) unexpected(word, "facet' or 'endsolid");
        read_facet();
      }
      reader_.skip_line();
    }
    if (facets == 0)
      fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the STL has no facet; export the mesh again");
    TriangleMesh mesh = builder_.finish();
    mesh.frame = tags_.frame();
    return mesh;
  }

 private:
  std::string_view next() { return reader_.word_of_any_line(); }

  [[noreturn]] void unexpected(std::string_view word, std::string_view expected) const {
    reader_.fail_malformed(
        fmt::format("expected '{}', found '{}'; export the mesh again", expected, printable(word)));
  }

  void expect(std::string_view expected) {
    const std::string_view word = next();
    if (!same_word(word, expected)) unexpected(word, expected);
  }

  void read_facet() {
    // Skips the normal: exporters write NaN for slivers.
    std::string_view word = reader_.word();
    while (!word.empty() && !same_word(word, "outer")) word = reader_.word();
    if (word.empty()) expect("outer");
    expect("loop");
    Corners corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (i % 3 == 0) expect("vertex");
      corners[i] = static_cast<float>(reader_.coordinate(next(), Precision::kFloat));
    }
    expect("endloop");
    expect("endfacet");
    add_facet(corners, builder_);
  }

  TextReader reader_;
  std::string_view file_;
  FrameTags tags_;
  MeshBuilder builder_{0};
};

}  // namespace

bool has_size_of_binary_stl(std::string_view content) {
  return content.size() >= kStlCountEnd &&
         content.size() == kStlCountEnd + kStlFacetBytes * facet_count(content);
}

bool begins_like_binary_stl(std::string_view content) {
  if (content.size() < kStlCountEnd + kStlFacetBytes) return false;
  const std::size_t counted = facet_count(content), whole = whole_facets(content);
  if (counted == 0 || counted / 65536 > whole || whole / 64 > counted) return false;
  for (std::size_t i = 0; i < std::min(counted, whole); ++i)
    if (!is_finite(corners_of(content, i))) return false;
  return true;
}

TriangleMesh read_binary_stl(std::string_view content, std::string_view file) {
  if (content.size() < kStlCountEnd)
    fail_mesh(ErrorCode::kMeshTruncated, file, fmt::format("byte {}", content.size()),
              "the file ends within its header; copy or export it again");
  const std::size_t facets = facet_count(content);
  const std::size_t size = kStlCountEnd + kStlFacetBytes * facets;
  if (content.size() < size)
    fail_mesh(ErrorCode::kMeshTruncated, file, fmt::format("byte {}", content.size()),
              fmt::format("the file ends after {} of the {} facets that its header counts; copy or "
                          "export it again",
                          whole_facets(content), facets));
  // Padding is harmless. Other bytes after the last facet mean that the count may be wrong, and an
  // error is better than a jaw with a part missing.
  if (content.find_first_not_of(std::string_view(" \t\r\n\0", 5), size) != content.npos)
    fail_mesh(ErrorCode::kNotAMesh, file, fmt::format("byte {}", size),
              fmt::format("{} bytes follow the {} facets that its header counts; export it again",
                          content.size() - size, facets));
  if (facets == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file, "", "the STL has no facet; export the mesh again");
  FrameTags tags(file);
  tags.read(content.substr(0, kStlHeaderBytes));
  MeshBuilder builder(facets);
  for (std::size_t i = 0; i < facets; ++i) {
    const Corners corners = corners_of(content, i);
    if (!is_finite(corners))
      fail_mesh(ErrorCode::kMeshNotFinite, file, fmt::format("facet {}", i),
                "a vertex is not finite; repair the mesh where it was made");
    add_facet(corners, builder);
  }
  TriangleMesh mesh = builder.finish();
  mesh.frame = tags.frame();
  return mesh;
}

TriangleMesh read_text_stl(std::string_view content, std::string_view file) {
  return TextStl(content, file).read();
}

}  // namespace ist
