#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/ordered_vector.h"
#include "ist/base/progress.h"
#include "ist/measure/point_search.h"

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

/// A triangle of a refined surface.
struct RefinedTriangle {
  std::array<std::uint32_t, 3> vertex;
  std::uint32_t of;  ///< the triangle of the mesh that it is a part of
};

/// Those parts of a surface that are near another body, in small triangles, with the signed
/// distance at their corners. Two triangles that share an edge of the mesh share those that it is
/// split into. Coordinates are the body's.
class RefinedSurface {
 public:
  struct Vertex {
    Eigen::Vector3d at;
    double distance;        ///< a lower bound where it is too far to matter
    std::uint32_t nearest;  ///< the body's triangle; kNoTriangle there
  };

  /// @param vertices     the mesh's, with their distances
  /// @param triangles    of the mesh: those to refine
  /// @param near         what is farther is left out
  /// @param longest_edge longer ones are split
  /// @param proceed      may end it: then it is not complete
  RefinedSurface(const SurfaceInBody& side, std::vector<Vertex> vertices,
                 std::span<const std::uint32_t> triangles, double near, double longest_edge,
                 const Proceed& proceed);

  [[nodiscard]] bool complete() const noexcept { return complete_; }

  [[nodiscard]] const std::vector<Vertex>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const std::vector<RefinedTriangle>& triangles() const noexcept {
    return triangles_;
  }
  [[nodiscard]] LevelTriangle corners(const RefinedTriangle& triangle) const noexcept;

 private:
  [[nodiscard]] bool add_vertices(const SurfaceInBody& side,
                                  std::span<const Eigen::Vector3d> points, double reach,
                                  const Proceed& proceed);
  [[nodiscard]] bool may_be_near(const RefinedTriangle& triangle, double near) const noexcept;
  [[nodiscard]] double longest_edge_of(const RefinedTriangle& triangle) const noexcept;
  [[nodiscard]] double length_squared(std::uint32_t a, std::uint32_t b) const noexcept;

  std::vector<Vertex> vertices_;
  std::vector<RefinedTriangle> triangles_;
  bool complete_ = true;
};

}  // namespace ist
