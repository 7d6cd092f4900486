#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/models/splint/clearance_map.h"

namespace ist {

/// The splint seen from above: a grid of constant width along the dental arch, from molar to molar.
/// Its triangles run counterclockwise. Coordinates are floats held as doubles.
class Horseshoe {
 public:
  Horseshoe();

  [[nodiscard]] std::span<const Eigen::Vector2d> points() const { return points_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

  /// Returns a rectangle of whole millimetres round all points.
  [[nodiscard]] PlaneBox area() const;

  /// Joins an upper and a lower face, heights of the points, by walls along the border.
  [[nodiscard]] TriangleMesh close(std::span<const double> upper,
                                   std::span<const double> lower) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> border_;  // counterclockwise
};

}  // namespace ist
