#pragma once

#include <Eigen/Core>
#include <span>

#include "ist/tree/ball.h"

namespace ist {

/// A ball that holds the points, at least one, with a radius at most `1 + tolerance` times the
/// smallest. Same unit and frame as the points. Contains them up to the rounding of one distance.
///
/// Works on the at most four points that the smallest ball of the points seen so far rests on, and
/// takes in the farthest point outside until none is far: the ball of a subset bounds the smallest
/// radius from below, so the tolerance is certain where the loop ends by it. Three to six passes on
/// surfaces; no allocation; deterministic; + - × ÷ √ only.
///
/// Source: B. Gärtner, Fast and robust smallest enclosing balls, ESA 1999 (the pivoting variant).
[[nodiscard]] Ball enclosing_ball(std::span<const Eigen::Vector3d> points,
                                  double tolerance) noexcept;

}  // namespace ist
