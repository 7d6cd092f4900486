#include "ist/models/splint/horseshoe.h"

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

TriangleMesh Horseshoe::close(std::span<const double> upper, std::span<const double> lower) const {
  const auto below = static_cast<std::uint32_t>(points_.size());
  TriangleMesh mesh;
  for (const std::span<const double> heights : {upper, lower}) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      mesh.vertices.emplace_back(points_[i].x(), points_[i].y(), heights[i]);
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
