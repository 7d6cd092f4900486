#pragma once

#include <Eigen/Core>
#include <span>

#include "ist/tree/bounds.h"

namespace ist {

/// Returns a bounding sphere of the points, at least one, with a radius of at most `1 + tolerance`
/// times the smallest; in the unit and frame of the points. The sphere holds them up to the
/// rounding of one distance.
///
/// Keeps the at most four support points of the smallest ball of the points seen so far, and adds
/// the farthest point outside until no point is far. The ball of a subset bounds the smallest
/// radius from below, so the tolerance is certain if the loop ends by it. Three to six passes on
/// surfaces; no allocation; deterministic; + - × ÷ √ only.
///
/// Source: B. Gärtner, Fast and robust smallest enclosing balls, ESA 1999 (the pivoting variant).
[[nodiscard]] Ball enclosing_ball(std::span<const Eigen::Vector3d> points,
                                  double tolerance) noexcept;
/// Returns the centre of that sphere.
[[nodiscard]] Eigen::Vector3d enclosing_centre(std::span<const Eigen::Vector3d> points,
                                               double tolerance) noexcept;

/// The smallest ball round a set of points or balls, and those of them that determine it.
template <typename Site>
struct Support {  // NOLINT(bugprone-reserved-identifier): clang-tidy 14 adds the name
  Site sites[4];
  int count = 0;
  Eigen::Vector3d centre;
  double size = 0;  ///< the square of the radius round points, the radius round balls
};

/// Replaces a support by that of the smallest ball round its sites and `ball`, which its ball does
/// not hold. Returns false, and changes nothing, if rounding hides that ball. Cost: 0.1 to 0.5 µs.
///
/// Source: K. Fischer, B. Gärtner, The smallest enclosing ball of balls, SoCG 2003.
[[nodiscard]] bool take_in(Support<Ball>& support, const Ball& ball) noexcept;

}  // namespace ist
