#include "models/splint/clearance_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "ist/base/parallel.h"

namespace ist {
namespace {

constexpr double kCellsPerMm = 16, kCell = 1 / kCellsPerMm;
constexpr double kNoSurface = std::numeric_limits<double>::infinity();
// Cells farther apart, in x or in y, have no two points within the clearance.
constexpr std::ptrdiff_t kReach = 4;
static_assert(kReach * kCell > kSplintClearance);
// More than all roundings of heights and places together, which are some 50 mm.
constexpr double kRounding = 1e-9;
// Steeper triangles count by their lowest vertex alone: the heights of their planes round too much.
constexpr double kSteepest = 1000;
constexpr std::size_t kRowsAtOnce = 32;

// How far a solid must stay below a point of the surface that is `dx` and `dy` cells aside;
// negative where it need not.
double drop(std::ptrdiff_t dx, std::ptrdiff_t dy) {
  const auto apart = [](std::ptrdiff_t cells) {
    return static_cast<double>(std::max<std::ptrdiff_t>(std::abs(cells) - 1, 0)) * kCell;
  };
  const double x = apart(dx), y = apart(dy);
  const double rest = kSplintClearance * kSplintClearance - (x * x + y * y);
  return rest > 0 ? std::sqrt(rest) + kRounding : -1;
}

// The cells of one row or column that an interval meets, first and last; places from the map's
// corner, at least 0.
std::pair<std::ptrdiff_t, std::ptrdiff_t> cells(double from, double to) {
  return {static_cast<std::ptrdiff_t>(from * kCellsPerMm),
          static_cast<std::ptrdiff_t>(to * kCellsPerMm)};
}

}  // namespace

ClearanceMap::ClearanceMap(const TriangleMesh& surface, const PlaneBox& area)
    : corner_(area.min - Eigen::Vector2d::Constant((kReach + 1) * kCell)),
      width_(cells(0, area.max.x() - corner_.x()).second + kReach + 2),
      height_(cells(0, area.max.y() - corner_.y()).second + kReach + 2),
      heights_(static_cast<std::size_t>(width_ * height_), kNoSurface) {
  for (const Triangle& t : surface.triangles) {
    lower_to(surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
  }
  subtract_clearance();
}

double ClearanceMap::lowest(const PlaneBox& box) const {
  const auto [left, right] = cells(box.min.x() - corner_.x(), box.max.x() - corner_.x());
  const auto [front, back] = cells(box.min.y() - corner_.y(), box.max.y() - corner_.y());
  double least = kNoSurface;
  for (std::ptrdiff_t y = front; y <= back; ++y) {
    for (std::ptrdiff_t x = left; x <= right; ++x) {
      least = std::min(least, heights_[static_cast<std::size_t>(y * width_ + x)]);
    }
  }
  return least;
}

// Lowers each cell that the triangle's bounding box meets to no more than the lowest point that the
// triangle has in the cell: the higher one of its lowest vertex and of its plane's lowest point.
void ClearanceMap::lower_to(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
  const Eigen::Vector2d extent =
      kCell * Eigen::Vector2d(static_cast<double>(width_), static_cast<double>(height_));
  const Eigen::Vector3d min = a.cwiseMin(b).cwiseMin(c), max = a.cwiseMax(b).cwiseMax(c);
  const Eigen::Vector2d from = min.head<2>() - corner_, to = max.head<2>() - corner_;
  if (to.x() < 0 || to.y() < 0 || from.x() > extent.x() || from.y() > extent.y()) return;
  const auto [left, right] = cells(std::max(from.x(), 0.0), std::min(to.x(), extent.x() - kCell));
  const auto [front, back] = cells(std::max(from.y(), 0.0), std::min(to.y(), extent.y() - kCell));

  const Eigen::Vector3d u = b - a, v = c - a;
  const double area = u.x() * v.y() - u.y() * v.x();
  const double rise_x = u.z() * v.y() - u.y() * v.z(), rise_y = u.x() * v.z() - u.z() * v.x();
  const double steep = std::abs(rise_x) + std::abs(rise_y);
  const bool has_plane = steep < kSteepest * std::abs(area);
  const double slope_x = has_plane ? rise_x / area : 0, slope_y = has_plane ? rise_y / area : 0;
  const double within_cell = (std::abs(slope_x) + std::abs(slope_y)) * (kCell / 2);
  for (std::ptrdiff_t y = front; y <= back; ++y) {
    const double from_a = (static_cast<double>(y) + 0.5) * kCell + corner_.y() - a.y();
    for (std::ptrdiff_t x = left; x <= right; ++x) {
      double low = min.z();
      if (has_plane) {
        const double beside_a = (static_cast<double>(x) + 0.5) * kCell + corner_.x() - a.x();
        low = std::max(low, a.z() + slope_x * beside_a + slope_y * from_a - within_cell);
      }
      double& height = heights_[static_cast<std::size_t>(y * width_ + x)];
      height = std::min(height, low);
    }
  }
}

// Cells along the border have no neighbours beyond it: they stay outside `area`.
void ClearanceMap::subtract_clearance() {
  std::vector<double> below(heights_.size(), kNoSurface);
  const auto rows = static_cast<std::size_t>(height_ - 2 * kReach);
  parallel_for(rows, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::ptrdiff_t y = static_cast<std::ptrdiff_t>(row) + kReach;
      double* const result = &below[static_cast<std::size_t>(y * width_)];
      for (std::ptrdiff_t dy = -kReach; dy <= kReach; ++dy) {
        for (std::ptrdiff_t dx = -kReach; dx <= kReach; ++dx) {
          const double by = drop(dx, dy);
          if (by < 0) continue;
          const double* const beside = &heights_[static_cast<std::size_t>((y + dy) * width_)] + dx;
          for (std::ptrdiff_t x = kReach; x < width_ - kReach; ++x) {
            result[x] = std::min(result[x], beside[x] - by);
          }
        }
      }
    }
  });
  heights_ = std::move(below);
}

}  // namespace ist
