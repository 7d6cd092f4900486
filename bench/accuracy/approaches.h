#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace ist::bench {

/// A straight way on which the lower jaw, turned a little, comes up to the upper one and into it.
struct Approach {
  Eigen::Isometry3d turned;   ///< the moving jaw's pose at the way's begin, t = 0
  Eigen::Vector3d direction;  ///< of unit length
  double pair;                ///< where triangles meet first, to within 1e-6 mm

  [[nodiscard]] Eigen::Isometry3d pose(double t) const {
    Eigen::Isometry3d at = turned;
    at.translation() += t * direction;
    return at;
  }
};

/// Where on a way from `from` on something touches first: looked for in steps of `step`, then
/// halved down to `within`. Negative where it never does before `to`, or already at `from`.
template <class Touches>
[[nodiscard]] double first_touch(double from, double to, double step, double within,
                                 const Touches& intersects) {
  if (intersects(from)) return -1;
  double free = from;
  while (!intersects(free + step)) {
    free += step;
    if (free > to) return -1;
  }
  double touching = free + step;
  while (touching - free > within) {
    const double middle = free + (touching - free) / 2;
    (intersects(middle) ? touching : free) = middle;
  }
  return touching;
}

/// So many of them, always the same: turned by up to 3 degrees about each axis (kHalfTurn),
/// inclined by up to 20 to each side (kBeside), from where surfaces are kApart from each other at
/// least. The exact contact is found by triangles.
[[nodiscard]] std::span<const Approach> approaches();

/// How far apart the surfaces are, by triangles, to within 2e-6 mm.
[[nodiscard]] double exact_gap(const Eigen::Isometry3d& pose);
/// Whether triangles meet.
[[nodiscard]] bool exact_touch(const Eigen::Isometry3d& pose);

/// Tangents: of half the largest turn about an axis, and of the largest inclination to a side.
inline constexpr double kHalfTurn = 0.026, kBeside = 0.36;
/// Where on a way the jaws would be closed but for the turn, mm.
inline constexpr double kWayBegin = 30;
/// mm: a touch that is shorter may be passed over.
inline constexpr double kStep = 0.2;
/// mm: more than the certain bound of any voxels that are measured.
inline constexpr double kApart = 6;

}  // namespace ist::bench
