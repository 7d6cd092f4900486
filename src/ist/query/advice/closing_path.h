#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "ist/query/advice/exact_bodies.h"

namespace ist {

/// One of the six ways along the axes of the fixed mesh.
struct Way {
  int axis = 0;   ///< 0 is x
  int sign = +1;  ///< or -1

  [[nodiscard]] Eigen::Vector3d vector() const noexcept {
    Eigen::Vector3d unit = Eigen::Vector3d::Zero();
    unit[axis] = sign;
    return unit;
  }
};

/// A straight way on which a moving body comes to a fixed one, without a turn. Places on it are how
/// far the body is from where its mesh stores it, in the opening direction, mesh units.
struct ClosingPath {
  Way opening;
  double begin;     ///< a little before it touches
  double touch;     ///< it touches here, and not a little, `accuracy`, further out
  double end;       ///< the deepest: where it is stored, or a little behind the touch
  double accuracy;  ///< of `touch`

  [[nodiscard]] Eigen::Isometry3d pose(double place) const noexcept;
  /// From begin to end, evenly. Precondition: at least 2.
  [[nodiscard]] std::vector<Eigen::Isometry3d> poses(std::size_t count) const;
};

/// The way on which the moving body's bounding box leaves the fixed one's soonest.
[[nodiscard]] Way opening_of(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving);

/// The last part of the way on which the moving body comes to where it is stored. Where it is not
/// free there, touching or inside, it is opened until it is, by steps that double; so it is the
/// nearest opening that is found, or one of them. Where it is free there it is moved the other way
/// until it touches, by no more than it may, and 1 % of the smaller body's diagonal deeper.
/// Everything is decided by triangles.
///
/// Nothing where the bodies are free and go past each other. A touch that is shorter than 1/1024 of
/// the smaller body's extent can be passed over. Cost: some 50 times that of ExactBodies; where
/// bodies pass each other at a small distance, a thousand times.
[[nodiscard]] std::optional<ClosingPath> find_closing_path(ExactBodies& bodies, Way opening);

}  // namespace ist
