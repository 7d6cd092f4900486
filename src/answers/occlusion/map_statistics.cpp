#include "answers/occlusion/map_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"

namespace ist::answers {
namespace {

constexpr double kBinMicrometres = 50;

// The known numbers of a map, the least first, each with its area.
std::vector<std::pair<double, double>> weighted(const BiteBody& body, std::span<const double> map,
                                                const std::optional<Eigen::AlignedBox3d>& region) {
  std::vector<double> areas(map.size());
  const RigidMove to_fixed(body.to_fixed);
  for (const Triangle& triangle : body.mesh->triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return to_fixed(body.mesh->vertices[triangle[i]]);
    };
    if (std::isnan(map[triangle[0]] + map[triangle[1]] + map[triangle[2]])) continue;
    const Eigen::Vector3d a = corner(0), b = corner(1), c = corner(2);
    if (region && !region->contains((a + b + c) / 3)) continue;
    const double third = length_in_order(cross_in_order(b - a, c - a)) / 6;
    for (const std::uint32_t v : triangle) areas[v] += third;
  }
  std::vector<std::pair<double, double>> numbers;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (areas[v] > 0) numbers.emplace_back(map[v], areas[v]);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

void fill_histogram(MapStatistics& out, const std::vector<std::pair<double, double>>& numbers) {
  const double first = std::floor(out.least / out.step), last = std::floor(out.most / out.step);
  out.from = first * out.step;
  out.histogram.resize(static_cast<std::size_t>(last - first) + 1);
  for (const auto& [number, area] : numbers) {
    out.histogram[static_cast<std::size_t>(std::floor(number / out.step) - first)] += area;
  }
}

void fill_percentiles(MapStatistics& out, const std::vector<std::pair<double, double>>& numbers) {
  double below = 0;
  std::size_t next = 0;
  out.percentiles.fill(out.most);
  for (const auto& [number, area] : numbers) {
    below += area;
    while (next < kPercentiles.size() && below >= 0.01 * kPercentiles[next] * out.area) {
      out.percentiles[next++] = number;
    }
  }
}

}  // namespace

std::optional<MapStatistics> map_statistics(const BiteBody& body, std::span<const double> map,
                                            double step,
                                            const std::optional<Eigen::AlignedBox3d>& region) {
  const auto numbers = weighted(body, map, region);
  if (numbers.empty()) return {};
  MapStatistics out;
  double sum = 0, squares = 0;
  for (const auto& [number, area] : numbers) {
    out.area += area;
    sum += area * number;
    squares += area * number * number;
  }
  out.mean = sum / out.area;
  out.root_mean_square = std::sqrt(squares / out.area);
  double spread = 0;
  for (const auto& [number, area] : numbers) spread += area * std::pow(number - out.mean, 2);
  out.deviation = std::sqrt(spread / out.area);
  out.least = numbers.front().first;
  out.most = numbers.back().first;
  out.step = step;
  fill_histogram(out, numbers);
  fill_percentiles(out, numbers);
  return out;
}

std::vector<double> distances_of(const BiteBody& body) {
  std::vector<double> distances;
  distances.reserve(body.surface.vertices.size());
  for (const SurfaceDistance& one : body.surface.vertices) distances.push_back(one.distance);
  return distances;
}

std::optional<MapStatistics> map_statistics(const BiteBody& body, const Bite& bite) {
  return map_statistics(body, distances_of(body), kBinMicrometres * bite.units_per_micrometre(),
                        bite.region);
}

}  // namespace ist::answers
