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

}  // namespace ist
