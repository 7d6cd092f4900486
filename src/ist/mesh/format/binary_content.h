#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ist {

/// A mesh file that passed its checks, in the form that assimp is given: binary STL, or binary PLY
/// with float coordinates and lists of indices, and nothing else in it. Text is rewritten because
/// assimp 5.2 misreads some of it without a word (its numbers keep 15 decimals and are rounded
/// twice; a line that begins with a blank is passed over) and runs past the end of other.
struct CheckedContent {
  const char* format = "";  ///< assimp's name of the format
  std::string bytes;
  std::size_t faces = 0;  ///< what assimp must find
};

/// Writes binary STL, facet by facet.
class StlContent {
 public:
  StlContent();
  void add_facet(const std::array<float, 9>& vertices);
  /// The content; leaves this object empty.
  [[nodiscard]] CheckedContent finish();

 private:
  std::string bytes_;
  std::size_t facets_ = 0;
};

/// Writes binary PLY: all vertices and faces, in any order of calls.
class PlyContent {
 public:
  PlyContent();
  void add_vertex(const std::array<float, 3>& vertex);
  /// The corners are indices of vertices, checked by the caller.
  void add_face(std::span<const std::uint32_t> corners);
  [[nodiscard]] std::size_t vertices() const { return vertices_.size() / 12 - 1; }
  [[nodiscard]] std::size_t faces() const { return face_count_; }
  /// The content; leaves this object empty.
  [[nodiscard]] CheckedContent finish();

 private:
  std::string vertices_;
  std::string faces_;
  std::size_t face_count_ = 0;
};

inline constexpr std::size_t kStlHeaderBytes = 80;
inline constexpr std::size_t kStlCountEnd = 84;
inline constexpr std::size_t kStlFacetBytes = 50;

}  // namespace ist
