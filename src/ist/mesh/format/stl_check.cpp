#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "ist/mesh/format/mesh_format.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

constexpr std::size_t kNormalBytes = 12;

// Returns the header's facet count. Precondition: the content holds the header and the count.
std::size_t facet_count(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + kStlHeaderBytes, sizeof count);
  return count;
}

std::size_t whole_facets(std::string_view content) {
  return (content.size() - kStlCountEnd) / kStlFacetBytes;
}

// Returns the first of n facets with a vertex that is not finite, or n.
std::size_t first_not_finite(std::string_view content, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    std::array<float, 9> vertices;
    std::memcpy(vertices.data(), content.data() + kStlCountEnd + i * kStlFacetBytes + kNormalBytes,
                sizeof vertices);
    if (!std::all_of(vertices.begin(), vertices.end(), [](float x) { return std::isfinite(x); }))
      return i;
  }
  return n;
}

class TextStl {
 public:
  TextStl(std::string_view content, std::string_view file) : reader_(content, file), file_(file) {}

  CheckedContent check() {
    std::size_t facets = 0;
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (!same_word(word, "solid")) unexpected(word, "solid");
      reader_.skip_line();  // the name, which may hold any words
      for (word = next(); !same_word(word, "endsolid"); word = next(), ++facets) {
        if (!same_word(word, "facet")) unexpected(word, "facet' or 'endsolid");
        read_facet();
      }
      reader_.skip_line();
    }
    if (facets == 0)
      fail_mesh(ErrorCode::kMeshEmpty, file_, "", "the STL has no facet; export the mesh again");
    const auto count = static_cast<std::uint32_t>(facets);
    std::memcpy(bytes_.data() + kStlHeaderBytes, &count, sizeof count);
    return {"stl", std::move(bytes_), facets};
  }

 private:
  std::string_view next() { return reader_.word_of_any_line(); }

  [[noreturn]] void unexpected(std::string_view word, std::string_view expected) const {
    reader_.fail_malformed(fmt::format("expected '{}', found '{}'; export the mesh again", expected,
                                       word.substr(0, 40)));
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
    std::array<float, 9> vertices{};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (i % 3 == 0) expect("vertex");
      vertices[i] = reader_.coordinate(next());
    }
    expect("endloop");
    expect("endfacet");
    char facet[kStlFacetBytes] = {};  // normals are computed from the winding, never read
    std::memcpy(facet + kNormalBytes, vertices.data(), sizeof vertices);
    bytes_.append(facet, sizeof facet);
  }

  TextReader reader_;
  std::string_view file_;
  std::string bytes_ = std::string(kStlCountEnd, '\0');  // re-encoded
};

}  // namespace

bool has_size_of_binary_stl(std::string_view content) {
  return content.size() >= kStlCountEnd &&
         content.size() == kStlCountEnd + kStlFacetBytes * facet_count(content);
}

bool begins_like_binary_stl(std::string_view content) {
  if (content.size() < kStlCountEnd + kStlFacetBytes || facet_count(content) == 0) return false;
  const std::size_t whole = std::min(facet_count(content), whole_facets(content));
  return first_not_finite(content, whole) == whole;
}

CheckedContent check_binary_stl(std::string content, std::string_view file) {
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
  if (content.find_first_not_of(std::string_view(" \t\r\n\0", 5), size) != std::string::npos)
    fail_mesh(ErrorCode::kNotAMesh, file, fmt::format("byte {}", size),
              fmt::format("{} bytes follow the {} facets that its header counts; export it again",
                          content.size() - size, facets));
  if (facets == 0)
    fail_mesh(ErrorCode::kMeshEmpty, file, "", "the STL has no facet; export the mesh again");
  if (const std::size_t bad = first_not_finite(content, facets); bad < facets)
    fail_mesh(ErrorCode::kMeshNotFinite, file, fmt::format("facet {}", bad),
              "a vertex is not finite; repair the mesh where it was made");
  // Clears the header, where assimp looks for byte order marks and colours.
  std::fill_n(content.begin(), kStlHeaderBytes, '\0');
  content.resize(size);
  return {"stl", std::move(content), facets};
}

CheckedContent check_text_stl(std::string_view content, std::string_view file) {
  return TextStl(content, file).check();
}

}  // namespace ist
