#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/progress.h"
#include "ist/measure/inside_parts.h"
#include "ist/measure/level_cut.h"

namespace ist {

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
