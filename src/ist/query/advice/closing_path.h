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

/// A straight way on which a moving body comes to a fixed one. Places on it are how far the body is
/// from where its mesh stores it, in the opening direction, mesh units.
struct ClosingPath {
  Eigen::Vector3d opening;                             ///< of unit length
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< of the moving body, all the way
  Eigen::Vector3d about = Eigen::Vector3d::Zero();     ///< the point of it that stays
  double begin = 0;                                    ///< a little before it touches
  double touch = 0;     ///< it touches here, and not a little, `accuracy`, further out
  double end = 0;       ///< the deepest: where it is stored, or a little behind the touch
  double accuracy = 0;  ///< of `touch`

  [[nodiscard]] Eigen::Isometry3d pose(double place) const noexcept;
  /// From begin to end, evenly. Precondition: at least 2.
  [[nodiscard]] std::vector<Eigen::Isometry3d> poses(std::size_t count) const;
};

/// The way on which the moving body's bounding box leaves the fixed one's soonest.
[[nodiscard]] Way opening_of(const Eigen::AlignedBox3d& fixed, const Eigen::AlignedBox3d& moving);

/// The last part of the way on which the moving body comes to where it is stored, and at least 1 %
/// of the smaller body's diagonal beyond where they touch. Where it is not free there, touching or
/// inside, it is opened until it is, by steps that double; so it is the nearest opening that is
/// found, or one of them. Where it is free there it is moved the other way until it touches.
/// Everything is decided by triangles.
///
/// Nothing where the bodies are free and go past each other. A touch that is shorter than 1/1024 of
/// the smaller body's extent, or 1/4096 of the way past each other, can be passed over. Cost: some
/// 50 times that of ExactBodies; where bodies pass each other at a small distance, 4,000 times.
[[nodiscard]] std::optional<ClosingPath> find_closing_path(ExactBodies& bodies, Way opening);

/// Ways beside one, for bodies seldom meet just as they are stored: inclined by 20 degrees to each
/// of six sides, and the moving body turned by 3 degrees about each of six axes, round the middle
/// of its box. They end where they touch. Those that find no free place to begin from, or go past
/// the fixed body, are left out.
///
/// Cost: that of find_closing_path for each.
[[nodiscard]] std::vector<ClosingPath> paths_beside(ExactBodies& bodies, const ClosingPath& path);

}  // namespace ist
