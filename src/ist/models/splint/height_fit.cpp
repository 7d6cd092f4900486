#include "ist/models/splint/height_fit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace ist {
namespace {

// A triangle is cut into kParts² parts, with sides about as long as the map's cells. A part lies
// below the lowest cell that it meets if its three corners do.
constexpr int kParts = 6;
constexpr std::size_t kPartCorners = (kParts + 1) * (kParts + 2) / 2;

constexpr std::size_t part_corner(int i, int j) {
  const int at = i * (2 * kParts + 3 - i) / 2 + j;
  return static_cast<std::size_t>(at);
}

// The shares of the triangle's corners in a part's corner, in kParts-ths.
using Shares = std::array<int, 3>;
constexpr std::array<Shares, kPartCorners> kShares = [] {
  std::array<Shares, kPartCorners> shares{};
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; i + j <= kParts; ++j) shares[part_corner(i, j)] = {kParts - i - j, i, j};
  }
  return shares;
}();

// How high each corner of the parts of a triangle may be.
using Limits = std::array<double, kPartCorners>;

Limits limits_of(const ClearanceMap& map, const std::array<Eigen::Vector2d, 3>& triangle,
                 double highest) {
  Limits limits;
  limits.fill(highest);
  const auto meet = [&](const std::array<std::size_t, 3>& part) {
    PlaneBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [a, b, c] = kShares[part[k]];
      const Eigen::Vector2d p = (a * triangle[0] + b * triangle[1] + c * triangle[2]) / kParts;
      box.min = k == 0 ? p : box.min.cwiseMin(p);
      box.max = k == 0 ? p : box.max.cwiseMax(p);
    }
    const double lowest = map.lowest(box);
    for (const std::size_t corner : part) limits[corner] = std::min(limits[corner], lowest);
  };
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j) {
      meet({part_corner(i, j), part_corner(i + 1, j), part_corner(i, j + 1)});
      if (i + j + 1 == kParts) continue;
      meet({part_corner(i + 1, j), part_corner(i + 1, j + 1), part_corner(i, j + 1)});
    }
  }
  return limits;
}

// Returns how high corner `own` of a triangle may be while its other two stay where they are.
double most_at(std::size_t own, const Limits& limits, const std::array<double, 3>& heights) {
  const std::size_t next = (own + 1) % 3, last = (own + 2) % 3;
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kPartCorners; ++i) {
    const Shares& shares = kShares[i];
    if (shares[own] == 0) continue;
    const double others = shares[next] * heights[next] + shares[last] * heights[last];
    most = std::min(most, (kParts * limits[i] - others) / shares[own]);
  }
  return most;
}

}  // namespace

// Each point starts at the lowest cell that its triangles meet, so that these lie below the map.
// Then each rises once as far as the triangles round it allow, the points of low cells first: where
// the map drops between two points, the lower one gets close to it, and the higher one stays
// behind.
std::vector<double> fit_below(const ClearanceMap& map, const Horseshoe& horseshoe, double highest) {
  const std::span<const Eigen::Vector2d> points = horseshoe.points();
  const std::span<const Triangle> triangles = horseshoe.triangles();
  std::vector<Limits> limits;
  std::vector<double> heights(points.size(), highest);
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> around(points.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    limits.push_back(limits_of(map, {points[a], points[b], points[c]}, highest));
    const double lowest = *std::min_element(limits[t].begin(), limits[t].end());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t point = triangles[t][k];
      heights[point] = std::min(heights[point], lowest);
      around[point].emplace_back(t, k);
    }
  }
  std::vector<std::pair<double, std::uint32_t>> order;  // no two are equal
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    order.emplace_back(map.lowest({points[i], points[i]}), i);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [cell, point] : order) {
    double most = highest;
    for (const auto& [t, k] : around[point]) {
      const auto& [a, b, c] = triangles[t];
      most = std::min(most, most_at(k, limits[t], {heights[a], heights[b], heights[c]}));
    }
    heights[point] = std::max(heights[point], most);
  }
  return heights;
}

}  // namespace ist
