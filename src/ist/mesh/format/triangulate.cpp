#include "ist/mesh/format/triangulate.h"

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/assert.h"
#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

// Returns twice the polygon's vector area; its direction is the normal. Works relative to the first
// corner, so that the polygon's distance from the origin adds no rounding error.
Eigen::Vector3d newell_normal(std::span<const std::uint32_t> corners,
                              std::span<const Eigen::Vector3d> vertices) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& origin = vertices[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (vertices[corners[i]] - origin).cross(vertices[corners[i + 1]] - origin);
  return normal;
}

class Polygon {
 public:
  Polygon(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices)
      : left_(corners.begin(), corners.end()),
        vertices_(vertices),
        normal_(newell_normal(corners, vertices)) {}

  [[nodiscard]] std::size_t size() const { return left_.size(); }

  // Returns a positive number if the path a, b, c turns left, seen against the normal.
  [[nodiscard]] double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return dot_in_order((vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[b]), normal_);
  }

  [[nodiscard]] Triangle corner(std::size_t i) const {
    const std::size_t n = left_.size();
    return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
  }

  [[nodiscard]] bool is_convex() const {
    for (std::size_t i = 0; i < size(); ++i) {
      const auto [a, b, c] = corner(i);
      if (turn(a, b, c) < 0) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const auto [a, b, c] = corner(i);
    if (!(turn(a, b, c) > 0)) return false;
    for (const std::uint32_t other : left_) {
      if (other == a || other == b || other == c) continue;
      if (turn(a, b, other) >= 0 && turn(b, c, other) >= 0 && turn(c, a, other) >= 0) return false;
    }
    return true;
  }

  void clip(std::size_t i) { left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i)); }

 private:
  std::vector<std::uint32_t> left_;
  std::span<const Eigen::Vector3d> vertices_;
  Eigen::Vector3d normal_;
};

}  // namespace

void triangulate(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices,
                 std::vector<Triangle>& out) {
  IST_ASSERT(corners.size() >= 3);
  if (corners.size() == 3) {
    out.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  Polygon polygon(corners, vertices);
  while (polygon.size() > 3 && !polygon.is_convex()) {
    std::size_t ear = 0;
    while (ear < polygon.size() && !polygon.is_ear(ear)) ++ear;
    if (ear == polygon.size()) break;  // self-intersecting: no triangulation is right
    out.push_back(polygon.corner(ear));
    polygon.clip(ear);
  }
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    out.push_back({polygon.corner(0)[1], polygon.corner(i)[1], polygon.corner(i + 1)[1]});
}

void triangulate_avoiding(std::span<const std::uint32_t> corners,
                          std::span<const Eigen::Vector3d> vertices,
                          const std::function<bool(std::uint32_t, std::uint32_t)>& is_free,
                          std::vector<Triangle>& out) {
  Polygon polygon(corners, vertices);
  while (polygon.size() > 3) {
    std::optional<std::size_t> ear;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto [a, b, c] = polygon.corner(i);
      const bool free = is_free(a, c);
      if ((ear && !free) || !polygon.is_ear(i)) continue;
      ear = i;
      if (free) break;
    }
    const std::size_t cut = ear.value_or(0);
    out.push_back(polygon.corner(cut));
    polygon.clip(cut);
  }
  out.push_back({polygon.corner(0)[1], polygon.corner(1)[1], polygon.corner(2)[1]});
}

}  // namespace ist
