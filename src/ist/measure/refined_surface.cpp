#include "ist/measure/refined_surface.h"

#include <algorithm>
#include <unordered_map>

#include "ist/base/throw_error.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// A point of a triangle is no farther than this part of the longest edge from its nearest corner.
constexpr double kToCorner = 0.5774;
constexpr double kRounding = 0x1p-40;
// Of one surface: some 0.5 GB.
constexpr std::size_t kMostTriangles = std::size_t{1} << 23;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

}  // namespace

RefinedSurface::RefinedSurface(const SurfaceInBody& side, std::vector<Vertex> vertices,
                               std::span<const std::uint32_t> triangles, double near,
                               double longest_edge, const Proceed& proceed)
    : vertices_(std::move(vertices)) {
  const TriangleMesh& mesh = *side.surface.triangles();
  std::vector<RefinedTriangle> open;
  for (const std::uint32_t k : triangles) {
    const Triangle& t = mesh.triangles[k];
    open.push_back({{t[0], t[1], t[2]}, k});
  }
  // Edges as short as the rounding of coordinates cannot be split.
  double size = longest_edge;
  for (const Vertex& vertex : vertices_) {
    size = std::max(size, kRounding * vertex.at.cwiseAbs().maxCoeff());
  }
  const double longest = size * size;
  while (!open.empty()) {
    std::vector<RefinedTriangle> next;
    std::unordered_map<std::uint64_t, std::uint32_t> middles;  // of this round's edges
    middles.reserve(open.size() + open.size() / 2);
    std::vector<Vector> points;
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    // Enough to leave out what is made of the longest triangle, and to hold what is inside.
    double reach = near;
    const auto middle_of = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(key_of(a, b), first + static_cast<std::uint32_t>(points.size()));
      const auto [low, high] = std::minmax(a, b);
      if (is_new) points.push_back(scaled(0.5, sum(vertices_[low].at, vertices_[high].at)));
      return found->second;
    };
    for (const RefinedTriangle& triangle : open) {
      if (!may_be_near(triangle, near)) continue;
      for (const std::uint32_t v : triangle.vertex) {
        reach = std::max(reach,
                         near + longest_edge_of(triangle) - std::min(0.0, vertices_[v].distance));
      }
      // Turned so that edges 0, or 0 and 1, or all are split.
      std::array<std::uint32_t, 3> v = triangle.vertex;
      const auto is_long = [&](std::size_t i) {
        return length_squared(v[i], v[(i + 1) % 3]) > longest;
      };
      const int count = int{is_long(0)} + int{is_long(1)} + int{is_long(2)};
      while (count != 0 && count != 3 && (!is_long(0) || is_long(2))) {
        std::rotate(v.begin(), v.begin() + 1, v.end());
      }
      if (count == 0) {
        triangles_.push_back(triangle);
        continue;
      }
      const std::uint32_t of = triangle.of, a = middle_of(v[0], v[1]);
      if (count == 1) {
        next.insert(next.end(), {{{v[0], a, v[2]}, of}, {{a, v[1], v[2]}, of}});
        continue;
      }
      const std::uint32_t b = middle_of(v[1], v[2]);
      next.push_back({{a, v[1], b}, of});
      if (count == 2) {
        next.insert(next.end(), {{{v[0], a, b}, of}, {{v[0], b, v[2]}, of}});
        continue;
      }
      const std::uint32_t c = middle_of(v[2], v[0]);
      next.insert(next.end(), {{{v[0], a, c}, of}, {{c, b, v[2]}, of}, {{a, b, c}, of}});
    }
    if (triangles_.size() + next.size() > kMostTriangles) {
      throw_error(ErrorCode::kMemoryLimit,
                  "longest_edge: with {} the surfaces near each other are over {} "
                  "triangles: give a longer one",
                  longest_edge, kMostTriangles);
    }
    complete_ = proceed(0) && add_vertices(side, points, reach, proceed);
    if (!complete_) return;
    open = std::move(next);
  }
}

bool RefinedSurface::add_vertices(const SurfaceInBody& side, std::span<const Vector> points,
                                  double reach, const Proceed& proceed) {
  const std::vector<SurfaceDistance> measured =
      distances_of(side.body, side.search, points, reach, proceed);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const SurfaceDistance& one = measured[i];
    const bool is_far = one.triangle == SurfaceDistance::kNoTriangle;
    vertices_.push_back({points[i], is_far ? reach : one.distance, one.triangle});
  }
  return measured.size() == points.size();
}

bool RefinedSurface::may_be_near(const RefinedTriangle& triangle, double near) const noexcept {
  double least = HUGE_VAL;
  for (const std::uint32_t v : triangle.vertex) least = std::min(least, vertices_[v].distance);
  return least - kToCorner * longest_edge_of(triangle) <= near;
}

double RefinedSurface::longest_edge_of(const RefinedTriangle& triangle) const noexcept {
  const auto& [a, b, c] = triangle.vertex;
  return std::sqrt(std::max({length_squared(a, b), length_squared(b, c), length_squared(c, a)}));
}

double RefinedSurface::length_squared(std::uint32_t a, std::uint32_t b) const noexcept {
  const Vector edge = difference(vertices_[a].at, vertices_[b].at);
  return dot_in_order(edge, edge);
}

LevelTriangle RefinedSurface::corners(const RefinedTriangle& triangle) const noexcept {
  LevelTriangle corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = vertices_[triangle.vertex[i]];
    corners[i] = {v.at, v.distance};
  }
  return corners;
}

}  // namespace ist
