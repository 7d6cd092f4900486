#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// One side of a triangle.
struct EdgeUse {
  std::uint32_t low = 0;   ///< the edge's lower vertex
  std::uint32_t high = 0;  ///< and its higher one
  std::uint32_t triangle = 0;
  bool forward = false;  ///< whether the triangle runs along it from low to high
};

/// The sides of all triangles, sorted by edge, then by triangle. A triangle with two equal indices
/// has no sides here: it bounds nothing.
///
/// Cost: O(t), a few milliseconds for 100,000 triangles.
[[nodiscard]] std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh);

[[nodiscard]] constexpr bool has_equal_indices(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Calls `body(uses)` for each edge, in order.
template <class Body>
void for_each_edge(std::span<const EdgeUse> uses, Body&& body) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high)
      ++end;
    body(uses.subspan(begin, end - begin));
  }
}

/// Sets of numbers that are joined two by two (union-find). The set's name is its lowest number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  [[nodiscard]] std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace ist
