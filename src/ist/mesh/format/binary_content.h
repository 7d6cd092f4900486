#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ist {

/// A checked mesh file, re-encoded for assimp as binary STL, or as binary PLY with float
/// coordinates and index lists only. Text is re-encoded because assimp 5.2 silently misreads some
/// of it (it keeps 15 decimals of a number and rounds twice; it skips a line that begins with a
/// blank) and reads past the end of other text.
struct CheckedContent {
  const char* format = "";  ///< assimp's name of the format
  std::string bytes;
  std::size_t faces = 0;  ///< the number of faces that assimp must find
};

/// Writes binary PLY. Vertices and faces may be added in any order.
class PlyContent {
 public:
  PlyContent();
  void add_vertex(const std::array<float, 3>& vertex);
  /// Adds a face. Precondition: `corners` are indices of vertices.
  void add_face(std::span<const std::uint32_t> corners);
  [[nodiscard]] std::size_t vertices() const { return vertices_.size() / 12 - 1; }
  [[nodiscard]] std::size_t faces() const { return face_count_; }
  /// Returns the content and leaves this object empty.
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
