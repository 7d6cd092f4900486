#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {

/// A corner of a piece of a surface, and the signed distance there.
struct LevelPoint {
  Eigen::Vector3d at;
  double distance;
};
using LevelTriangle = std::array<LevelPoint, 3>;

/// The part of a triangle where a distance, linear on it, is at most a level.
struct LevelCut {
  double area = 0;
  double below = 0;                                  ///< ∫ (level - distance) dA
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< ∫ x dA
};

[[nodiscard]] inline double area_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) noexcept {
  const Eigen::Vector3d normal = cross_in_order(difference(b, a), difference(c, a));
  return 0.5 * std::sqrt(dot_in_order(normal, normal));
}

[[nodiscard]] inline LevelCut cut_at(const LevelTriangle& triangle, double level) noexcept {
  std::array<LevelPoint, 4> corner;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const LevelPoint &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (a.distance <= level) corner[count++] = a;
    if ((a.distance <= level) == (b.distance <= level)) continue;
    const double part = (level - a.distance) / (b.distance - a.distance);
    corner[count++] = {sum(a.at, scaled(part, difference(b.at, a.at))), level};
  }
  LevelCut cut;
  for (std::size_t k = 2; k < count; ++k) {
    const LevelPoint &a = corner[0], &b = corner[k - 1], &c = corner[k];
    const double area = area_of(a.at, b.at, c.at);
    cut.area += area;
    cut.below += area * (level - ((a.distance + b.distance) + c.distance) / 3);
    add_to(cut.moment, scaled(area / 3, sum(sum(a.at, b.at), c.at)));
  }
  return cut;
}

}  // namespace ist
