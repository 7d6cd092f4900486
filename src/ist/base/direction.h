#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "ist/base/ordered_vector.h"

namespace ist {

/// A vector's length, and the unit vector along it.
struct Direction {
  Eigen::Vector3d unit;
  double length;  ///< infinity, if no double holds it
};

/// Returns the direction of a vector of any length but 0. Returns nothing for a zero vector, and
/// for a number that is not finite. A power of two scales the vector first: no square underflows or
/// overflows, and other vectors keep the bits that they have without it.
[[nodiscard]] inline std::optional<Direction> direction_of(const Eigen::Vector3d& v) noexcept {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0) || !std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) {
    return std::nullopt;
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  const Eigen::Vector3d near_one(std::ldexp(v[0], -exponent), std::ldexp(v[1], -exponent),
                                 std::ldexp(v[2], -exponent));
  const double length = length_in_order(near_one);
  return Direction{scaled(1 / length, near_one), std::ldexp(length, exponent)};
}

}  // namespace ist
