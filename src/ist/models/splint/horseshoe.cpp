#include "ist/models/splint/horseshoe.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "ist/models/jaw/jaw_section.h"

namespace ist {
namespace {

// The grid: steps along the arch on each side, and across it; mm.
constexpr std::ptrdiff_t kStepsAlong = 144, kStepsAcross = 28;
constexpr double kStep = 0.375;
// The splint's edge at the tongue; lower teeth stand on the arch, upper teeth 2 to 3 mm outside.
constexpr double kInnerEdge = -4.5;
// Parts of a triangle's side, about as long as the map's cells.
constexpr int kParts = 6;

}  // namespace

Horseshoe::Horseshoe() {
  const Arch arch;
  for (std::ptrdiff_t i = -kStepsAlong; i <= kStepsAlong; ++i) {
    const ArchFrame frame = arch.at(static_cast<double>(std::abs(i)) * kStep);
    for (std::ptrdiff_t j = 0; j <= kStepsAcross; ++j) {
      const Eigen::Vector2d p =
          frame.point + (kInnerEdge + static_cast<double>(j) * kStep) * frame.outward;
      points_.push_back(
          Eigen::Vector2d(i < 0 ? -p.x() : p.x(), p.y()).cast<float>().cast<double>());
    }
  }
  const auto at = [](std::ptrdiff_t i, std::ptrdiff_t j) {
    return static_cast<std::uint32_t>(i * (kStepsAcross + 1) + j);
  };
  // From left to right along the arch and from tongue to cheek is clockwise.
  constexpr std::ptrdiff_t kLast = 2 * kStepsAlong;
  for (std::ptrdiff_t i = 0; i < kLast; ++i) {
    for (std::ptrdiff_t j = 0; j < kStepsAcross; ++j) {
      triangles_.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      triangles_.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  for (std::ptrdiff_t j = 0; j < kStepsAcross; ++j) border_.push_back(at(0, j));
  for (std::ptrdiff_t i = 0; i < kLast; ++i) border_.push_back(at(i, kStepsAcross));
  for (std::ptrdiff_t j = kStepsAcross; j > 0; --j) border_.push_back(at(kLast, j));
  for (std::ptrdiff_t i = kLast; i > 0; --i) border_.push_back(at(i, 0));
}

PlaneBox Horseshoe::area() const {
  PlaneBox box{points_[0], points_[0]};
  for (const Eigen::Vector2d& p : points_) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  const auto whole = [](double x, double beyond) {
    return static_cast<double>(static_cast<std::int64_t>(x)) + beyond;
  };
  return {{whole(box.min.x(), -1), whole(box.min.y(), -1)},
          {whole(box.max.x(), 1), whole(box.max.y(), 1)}};
}

// Each triangle is pushed down below the map in turn. Heights only fall, so what lies below the map
// stays below it.
std::vector<double> Horseshoe::fit_below(const ClearanceMap& map, double highest) const {
  std::vector<double> heights;
  for (const Eigen::Vector2d& p : points_) heights.push_back(std::min(highest, map.lowest({p, p})));
  for (const Triangle& triangle : triangles_) push_down(map, triangle, heights);
  return heights;
}

// Cuts the triangle into kParts² parts. A part lies below the map if its three corners lie below
// the lowest cell that it meets. A corner's height is a mean of the triangle's heights, and is
// lowered by the least change of these (least in squares): the nearest one most.
void Horseshoe::push_down(const ClearanceMap& map, const Triangle& triangle,
                          std::vector<double>& heights) const {
  const Eigen::Vector2d &a = points_[triangle[0]], &b = points_[triangle[1]],
                        &c = points_[triangle[2]];
  const auto part_below = [&](const std::array<Eigen::Vector3d, 3>& corners) {
    PlaneBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& w = corners[k];
      const Eigen::Vector2d p = w.x() * a + w.y() * b + w.z() * c;
      box.min = k == 0 ? p : box.min.cwiseMin(p);
      box.max = k == 0 ? p : box.max.cwiseMax(p);
    }
    const double most = map.lowest(box);
    for (const Eigen::Vector3d& w : corners) {
      const double height = w.x() * heights[triangle[0]] + w.y() * heights[triangle[1]] +
                            w.z() * heights[triangle[2]];
      if (height <= most) continue;
      const double by = (height - most) / (w.x() * w.x() + w.y() * w.y() + w.z() * w.z());
      for (std::size_t k = 0; k < 3; ++k) {
        heights[triangle[k]] -= by * w[static_cast<Eigen::Index>(k)];
      }
    }
  };
  const auto weights = [](int i, int j) -> Eigen::Vector3d {
    return Eigen::Vector3d(kParts - i - j, i, j) / kParts;
  };
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j) {
      part_below({weights(i, j), weights(i + 1, j), weights(i, j + 1)});
      if (i + j + 1 == kParts) continue;
      part_below({weights(i + 1, j), weights(i + 1, j + 1), weights(i, j + 1)});
    }
  }
}

TriangleMesh Horseshoe::close(const std::vector<double>& upper,
                              const std::vector<double>& lower) const {
  const auto below = static_cast<std::uint32_t>(points_.size());
  TriangleMesh mesh;
  for (const std::vector<double>* heights : {&upper, &lower}) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      mesh.vertices.emplace_back(points_[i].x(), points_[i].y(), (*heights)[i]);
    }
  }
  mesh.triangles = triangles_;
  for (const auto& [a, b, c] : triangles_) {
    mesh.triangles.push_back({below + a, below + c, below + b});
  }
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const std::uint32_t a = border_[i], b = border_[(i + 1) % border_.size()];
    mesh.triangles.push_back({below + a, below + b, b});
    mesh.triangles.push_back({below + a, b, a});
  }
  return mesh;
}

}  // namespace ist
