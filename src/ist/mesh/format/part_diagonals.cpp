#include "ist/mesh/format/part_diagonals.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/mesh/format/triangulate.h"

namespace ist {
namespace {

using PolygonCorners = std::span<const std::uint32_t>;

std::uint64_t edge(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

std::array<std::uint64_t, 3> edges_of(const Triangle& t) {
  return {edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])};
}

// The sides of a polygon, to look up.
class Sides {
 public:
  void take(const PolygonCorners& polygon) {
    sides_.clear();
    std::uint32_t last = polygon.back();
    for (const std::uint32_t corner : polygon) {
      sides_.push_back(edge(last, corner));
      last = corner;
    }
    std::sort(sides_.begin(), sides_.end());
  }
  [[nodiscard]] bool hold(std::uint64_t of) const {
    return std::binary_search(sides_.begin(), sides_.end(), of);
  }

 private:
  std::vector<std::uint64_t> sides_;
};

// How many sides of triangles an edge is.
class EdgeUses {
 public:
  explicit EdgeUses(const std::vector<Triangle>& triangles) {
    edges_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
      for (const std::uint64_t each : edges_of(t)) edges_.push_back(each);
    }
    std::sort(edges_.begin(), edges_.end());
  }

  [[nodiscard]] bool is_any_above_two() const {
    for (std::size_t i = 2; i < edges_.size(); ++i) {
      if (edges_[i] == edges_[i - 2]) return true;
    }
    return false;
  }
  [[nodiscard]] std::ptrdiff_t of(std::uint64_t each) const {
    const auto [begin, end] = std::equal_range(edges_.begin(), edges_.end(), each);
    const auto change = changes_.find(each);
    return end - begin + (change == changes_.end() ? 0 : change->second);
  }
  void add(std::span<const Triangle> triangles, std::ptrdiff_t times) {
    for (const Triangle& t : triangles) {
      for (const std::uint64_t each : edges_of(t)) changes_[each] += times;
    }
  }

 private:
  std::vector<std::uint64_t> edges_;                           // sorted, each as often as used
  std::unordered_map<std::uint64_t, std::ptrdiff_t> changes_;  // since then
};

bool shares_diagonal(const Sides& sides, std::span<const Triangle> triangles,
                     const EdgeUses& uses) {
  for (const Triangle& t : triangles) {
    for (const std::uint64_t each : edges_of(t)) {
      if (uses.of(each) > 2 && !sides.hold(each)) return true;
    }
  }
  return false;
}

}  // namespace

void part_diagonals(std::span<const std::uint32_t> polygons, TriangleMesh& mesh) {
  EdgeUses uses(mesh.triangles);
  if (!uses.is_any_above_two()) return;
  std::vector<Triangle> cut;
  Sides sides;
  // A polygon may have no free diagonal until a later one is cut anew.
  for (int round = 0; round < 2; ++round) {
    std::size_t next = 0;
    for (std::size_t at = 0; at < polygons.size(); at += polygons[at] + 1) {
      const PolygonCorners polygon = polygons.subspan(at + 1, polygons[at]);
      const std::span<Triangle> triangles(&mesh.triangles[next], polygon.size() - 2);
      next += triangles.size();
      if (polygon.size() == 3) continue;
      sides.take(polygon);
      if (!shares_diagonal(sides, triangles, uses)) continue;
      cancellation_point();
      uses.add(triangles, -1);
      cut.clear();
      const auto is_free = [&](std::uint32_t a, std::uint32_t b) {
        return uses.of(edge(a, b)) == 0 && !sides.hold(edge(a, b));
      };
      triangulate_avoiding(polygon, mesh.vertices, is_free, cut);
      std::copy(cut.begin(), cut.end(), triangles.begin());
      uses.add(triangles, 1);
    }
  }
}

}  // namespace ist
