#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace ist {

/// A convex polygon in space: a triangle cut by the six planes of a box. That makes nine corners at
/// most, and rounding may add a few.
struct ClippedTriangle {
  static constexpr int kMaxCorners = 12;
  std::array<Eigen::Vector3d, kMaxCorners> corners;
  int count = 0;  ///< 0 when nothing is left

  /// Area of the projection along a coordinate axis, in the square of the coordinates' unit.
  [[nodiscard]] double projected_area(int axis) const noexcept;
};

/// The part of `polygon` between two planes, low <= coordinate `axis` <= high. Corners keep their
/// turn. Returns `polygon` itself where nothing is cut, else `result`.
///
/// Cost: 5 to 40 ns. Source: I. E. Sutherland, G. W. Hodgman, Reentrant polygon clipping, CACM
/// 17(1), 1974.
const ClippedTriangle& clip_between(const ClippedTriangle& polygon, int axis, double low,
                                    double high, ClippedTriangle& result) noexcept;

/// The part of a triangle inside the closed box [low, high]. Corners keep the triangle's turn.
void clip_triangle(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& low,
                   const Eigen::Vector3d& high, ClippedTriangle& result) noexcept;

/// Clips one triangle to many unit cubes of the lattice, each grown by a pad. Where calls come in
/// order of z, then y, then x, each layer and row of cubes is cut but once.
class TriangleSlicer {
 public:
  TriangleSlicer(const std::array<Eigen::Vector3d, 3>& triangle, double pad) noexcept;

  /// The part of the triangle inside the cube at (x, y, z). Good until the next call.
  const ClippedTriangle& cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept;

 private:
  ClippedTriangle whole_, layer_, row_, cube_;
  const ClippedTriangle* in_layer_ = nullptr;  // the part of the triangle in layer z_
  const ClippedTriangle* in_row_ = nullptr;    // and in row y_ of it
  std::uint32_t y_ = 0, z_ = 0;
  double pad_;
};

}  // namespace ist
