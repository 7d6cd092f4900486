#include "ist/constraint/surface.h"

#include <algorithm>
#include <tuple>

#include "ist/base/ordered_vector.h"
#include "ist/mesh/weld.h"

namespace ist {
namespace {

// Two triangles lie in one plane if the sines of their angles to it differ by less.
constexpr double kFlat = 1e-6;

// An edge of a triangle.
struct EdgeSide {
  std::uint32_t low, high, triangle, number;

  [[nodiscard]] bool is_beside(const EdgeSide& other) const {
    return low == other.low && high == other.high;
  }
};

std::size_t bytes_of(const auto& vector) { return vector.capacity() * sizeof(vector[0]); }

// Returns whether a vector ascends along a direction of unit length by more than `tolerance`.
bool ascends(const Eigen::Vector3d& v, const Eigen::Vector3d& direction,
             double tolerance) noexcept {
  const double along = dot_in_order(v, direction);
  return along > 0 && along * along > (tolerance * tolerance) * square_in_order(v);
}

}  // namespace

Surface::Surface(const TriangleMesh& mesh) : mesh_(mesh), first_(first_at_position(mesh.vertices)) {
  find_edges();
  find_flat_parts();
}

void Surface::find_edges() {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * mesh_.triangles.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = first_[mesh_.triangles[t][k]];
      const std::uint32_t b = first_[mesh_.triangles[t][(k + 1) % 3]];
      sides.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.low, a.high, a.triangle, a.number) <
           std::tie(b.low, b.high, b.triangle, b.number);
  });
  edges_.resize(mesh_.triangles.size());
  std::vector<std::uint32_t> degree(mesh_.vertices.size() + 1, 0);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const EdgeSide& side = sides[i];
    if (i == 0 || !side.is_beside(sides[i - 1])) {
      ends_.push_back({side.low, side.high});
      opposite_.begin.push_back(static_cast<std::uint32_t>(opposite_.items.size()));
      ++degree[side.low];
      ++degree[side.high];
    }
    edges_[side.triangle][side.number] = static_cast<std::uint32_t>(ends_.size() - 1);
    opposite_.items.push_back(first_[mesh_.triangles[side.triangle][(side.number + 2) % 3]]);
  }
  opposite_.begin.push_back(static_cast<std::uint32_t>(opposite_.items.size()));

  std::uint32_t sum = 0;
  for (std::uint32_t& count : degree) {
    neighbours_.begin.push_back(sum);
    sum += std::exchange(count, sum);
  }
  neighbours_.items.resize(sum);
  for (const auto& [low, high] : ends_) {
    neighbours_.items[degree[low]++] = high;
    neighbours_.items[degree[high]++] = low;
  }
}

// Returns the way from an edge to the third corner of one of its triangles, across the edge.
Eigen::Vector3d Surface::across(std::uint32_t edge, std::uint32_t opposite) const noexcept {
  const Eigen::Vector3d& from = mesh_.vertices[ends_[edge][0]];
  const Eigen::Vector3d along = difference(mesh_.vertices[ends_[edge][1]], from);
  const Eigen::Vector3d way = difference(mesh_.vertices[opposite], from);
  const double square = square_in_order(along);
  if (!(square > 0)) return way;
  return difference(way, scaled(dot_in_order(way, along) / square, along));
}

void Surface::find_flat_parts() {
  flat_edges_.assign(ends_.size(), false);
  flat_vertices_.assign(mesh_.vertices.size(), true);
  for (std::uint32_t e = 0; e < ends_.size(); ++e) {
    const std::uint32_t begin = opposite_.begin[e], end = opposite_.begin[e + 1];
    if (end - begin == 2) {
      const Eigen::Vector3d a = across(e, opposite_.items[begin]);
      const Eigen::Vector3d b = across(e, opposite_.items[begin + 1]);
      const double first = length_in_order(a), second = length_in_order(b);
      flat_edges_[e] = first > 0 && second > 0 &&
                       length_in_order(sum(scaled(1 / first, a), scaled(1 / second, b))) < kFlat;
    }
    if (!flat_edges_[e]) flat_vertices_[ends_[e][0]] = flat_vertices_[ends_[e][1]] = false;
  }
}

SurfacePart Surface::part(std::uint32_t triangle, TrianglePart part) const noexcept {
  using Kind = SurfacePart::Kind;
  if (part == TrianglePart::kFace) return {Kind::kFace, triangle};
  if (part >= TrianglePart::kEdge0) {
    const auto edge =
        static_cast<std::size_t>(part) - static_cast<std::size_t>(TrianglePart::kEdge0);
    return {Kind::kEdge, edges_[triangle][edge]};
  }
  return {Kind::kVertex, first_[mesh_.triangles[triangle][static_cast<std::size_t>(part)]]};
}

bool Surface::is_flat(const SurfacePart& part) const noexcept {
  if (part.kind == SurfacePart::Kind::kVertex) return flat_vertices_[part.index];
  return part.kind == SurfacePart::Kind::kEdge && flat_edges_[part.index];
}

bool Surface::leaves(const SurfacePart& part, const Eigen::Vector3d& direction,
                     double tolerance) const noexcept {
  if (part.kind == SurfacePart::Kind::kFace) return true;
  if (part.kind == SurfacePart::Kind::kVertex) {
    const Eigen::Vector3d& at = mesh_.vertices[part.index];
    for (std::uint32_t i = neighbours_.begin[part.index]; i < neighbours_.begin[part.index + 1];
         ++i) {
      const Eigen::Vector3d& other = mesh_.vertices[neighbours_.items[i]];
      if (ascends(difference(other, at), direction, tolerance)) return false;
    }
    return true;
  }
  for (std::uint32_t i = opposite_.begin[part.index]; i < opposite_.begin[part.index + 1]; ++i) {
    if (ascends(across(part.index, opposite_.items[i]), direction, tolerance)) return false;
  }
  return true;
}

std::size_t Surface::bytes() const noexcept {
  return bytes_of(first_) + bytes_of(edges_) + bytes_of(ends_) + bytes_of(opposite_.begin) +
         bytes_of(opposite_.items) + bytes_of(neighbours_.begin) + bytes_of(neighbours_.items) +
         (flat_vertices_.capacity() + flat_edges_.capacity()) / 8;
}

}  // namespace ist
