#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ist/mesh/mesh.h"
#include "ist/models/splint/clearance_map.h"

namespace ist {

/// The splint seen from above: a grid of constant width along the dental arch, from molar to molar.
/// Coordinates are floats held as doubles.
class Horseshoe {
 public:
  Horseshoe();

  /// Returns a rectangle of whole millimetres round all points.
  [[nodiscard]] PlaneBox area() const;

  /// Returns the heights of the points such that the triangles between them stay below the heights
  /// of the map and of `highest`, and as close to them as this grid and its order of work allow.
  [[nodiscard]] std::vector<double> fit_below(const ClearanceMap& map, double highest) const;

  /// Joins an upper and a lower face of the grid by walls along its border.
  [[nodiscard]] TriangleMesh close(const std::vector<double>& upper,
                                   const std::vector<double>& lower) const;

 private:
  void push_down(const ClearanceMap& map, const Triangle& triangle,
                 std::vector<double>& heights) const;

  std::vector<Eigen::Vector2d> points_;
  std::vector<Triangle> triangles_;    // counterclockwise as seen from above
  std::vector<std::uint32_t> border_;  // counterclockwise as seen from above
};

}  // namespace ist
