#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Gives each place one index: points with the same three floats are one vertex, exactly, and -0
/// is 0. Vertices are in the order of their first appearance.
///
/// Cost: O(1) a point on average.
class Welder {
 public:
  /// For at most `points` calls of index_of.
  explicit Welder(std::size_t points);
  /// The vertex at a place, made if there is none. The coordinates are finite.
  [[nodiscard]] std::uint32_t index_of(std::array<float, 3> point);
  [[nodiscard]] const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }

 private:
  std::vector<std::array<float, 3>> points_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> slots_;  // open addressing: an index, or kFree; the size is 2^n
};

}  // namespace ist
