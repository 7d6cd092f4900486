#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "answers/occlusion/bite.h"

namespace ist::answers {

/// The percentiles of a map.
inline constexpr std::array<int, 7> kPercentiles = {1, 5, 25, 50, 75, 95, 99};

/// How the numbers of a map are distributed over the surface. Every number weighs as much as the
/// area round its vertex. Numbers are in mesh units, areas in mesh units².
struct MapStatistics {
  double area = 0;                 ///< of the triangles with a number at each corner
  double mean = 0, deviation = 0;  ///< standard deviation from the mean
  double root_mean_square = 0;     ///< of the numbers
  double least = 0, most = 0;      ///< the ends of the range
  std::array<double, kPercentiles.size()> percentiles{};
  double from = 0, step = 0;      ///< of the histogram: bin i begins at from + i · step
  std::vector<double> histogram;  ///< area of each bin, whose end belongs to the next one
};

/// Returns the statistics of a map over a body. Each triangle with a known number at all corners
/// gives a third of its area to each of them. Percentile p is the least number such that p % of the
/// area have it or a smaller one.
///
/// @param body   the surface
/// @param map    a number for each vertex, NaN if it is not known
/// @param step   of the histogram, mesh units, above 0; bins begin at multiples of it
/// @param region only triangles with their centroid in this box count, fixed coordinates
///
/// Returns nothing if no triangle counts.
[[nodiscard]] std::optional<MapStatistics> map_statistics(
    const BiteBody& body, std::span<const double> map, double step,
    const std::optional<Eigen::AlignedBox3d>& region);

/// Returns the signed distances of the vertices of a body.
[[nodiscard]] std::vector<double> distances_of(const BiteBody& body);

/// Returns the statistics of the distances of a body, with bins of 50 µm.
[[nodiscard]] std::optional<MapStatistics> map_statistics(const BiteBody& body, const Bite& bite);

}  // namespace ist::answers
