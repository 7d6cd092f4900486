#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/tree/outer_balls.h"

/// The interface of the kernels that bound depths by outer balls, and their scalar forms, which
/// specify the vector forms: the same operations in the same order, so the same bits. Lengths are
/// in units of the field, coordinates are about its middle.
namespace ist {

/// A field of outer balls, in plain numbers.
struct BallGrid {
  const std::int32_t* first;  ///< OuterBalls::first
  const OuterBall* balls;
  float low[3], last[3];  ///< the least coordinate; half a cell less than the number of cells
  float cell_back;        ///< cells in a unit
  std::int32_t groups[3];
  float half[3];  ///< of the box round the body
};

/// The motion from a surface's cluster frame to a field, p becomes rotation · (scale · p) +
/// translation, and the rounding of that in float.
struct BallPose {
  float rotation[3][3], translation[3];
  float scale;  ///< a power of two
  float pad;
};

/// Bounds rounding of a distance, as a part of it and of the radius.
inline constexpr float kBallRounding = 0x1p-18F;

/// Lanes whose bounds exceed a limit, as bits, and the largest bound of the others.
struct BallLanes {
  std::uint32_t over;
  float most;  ///< -infinity without others
};

/// Writes bounds of the depths of all points in sixteen nodes. `lanes` are those in use. A bound
/// that is no number exceeds any limit.
using BoundNodesFunction = BallLanes (*)(const NodeBlock& nodes, const BallGrid& grid,
                                         const BallPose& pose, float limit, std::uint32_t lanes,
                                         float* bounds);

/// Writes bounds of the depths of all points of the triangles in a cluster, whose bounds are in
/// lane `lane` of `nodes`: a bound is convex over a triangle, and so is largest at a corner.
using BoundCornersFunction = BallLanes (*)(const TriangleCluster& cluster, const NodeBlock& nodes,
                                           std::size_t lane, const BallGrid& grid,
                                           const BallPose& pose, float limit, std::uint32_t lanes,
                                           float* bounds);

/// The corners of a triangle: corner, coordinate.
using BallTriangle = std::array<std::array<float, 3>, 3>;

/// Returns the least bound of the depths of all points of a triangle, by the balls of the cell
/// that holds its middle and of the 26 cells round it. `pad` is added.
using BoundAroundFunction = float (*)(const BallTriangle& triangle, const BallGrid& grid,
                                      float pad);

/// The scalar forms.
BallLanes bound_nodes_scalar(const NodeBlock& nodes, const BallGrid& grid, const BallPose& pose,
                             float limit, std::uint32_t lanes, float* bounds);
BallLanes bound_corners_scalar(const TriangleCluster& cluster, const NodeBlock& nodes,
                               std::size_t lane, const BallGrid& grid, const BallPose& pose,
                               float limit, std::uint32_t lanes, float* bounds);
float bound_around_scalar(const BallTriangle& triangle, const BallGrid& grid, float pad);

[[nodiscard]] inline BallGrid grid_of(const OuterBalls& field) noexcept {
  BallGrid grid{field.first.data(), field.balls.data(), {}, {}, 1 / field.cell, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    grid.low[i] = field.low(i);
    grid.last[i] = static_cast<float>(OuterBalls::kGroup * field.groups[i]) - 0.5F;
    grid.groups[i] = static_cast<std::int32_t>(field.groups[i]);
    grid.half[i] = field.half[i];
  }
  return grid;
}

/// Returns the cell of a coordinate along an axis, or the nearest one of the grid.
[[nodiscard]] inline std::int32_t cell_of(const BallGrid& grid, float coordinate,
                                          std::size_t axis) noexcept {
  const float at = (coordinate - grid.low[axis]) * grid.cell_back;
  const float above = at > 0 ? at : 0;
  return static_cast<std::int32_t>(above < grid.last[axis] ? above : grid.last[axis]);
}

/// Returns the place of a cell's ball.
[[nodiscard]] inline std::int32_t ball_at(const BallGrid& grid, std::int32_t x, std::int32_t y,
                                          std::int32_t z) noexcept {
  const std::int32_t group = ((z >> 2) * grid.groups[1] + (y >> 2)) * grid.groups[0] + (x >> 2);
  const std::int32_t entry = grid.first[group];
  const std::int32_t within = (((z & 3) << 4) | ((y & 3) << 2)) | (x & 3);
  return (entry >> 1) + (within & -(entry & 1));
}

/// Returns the places of the balls of the cells round a point: 27, and the last one five times
/// more.
[[nodiscard]] inline std::array<std::int32_t, 32> balls_around(const BallGrid& grid,
                                                               const float (&at)[3]) noexcept {
  std::int32_t middle[3];
  for (std::size_t i = 0; i < 3; ++i) middle[i] = cell_of(grid, at[i], i);
  const auto clamped = [&](std::int32_t cell, std::size_t i) {
    const std::int32_t last = 4 * grid.groups[i] - 1;
    return cell < 0 ? 0 : cell < last ? cell : last;
  };
  std::array<std::int32_t, 32> places;
  std::size_t count = 0;
  for (std::int32_t z = -1; z <= 1; ++z) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t x = -1; x <= 1; ++x) {
        places[count++] = ball_at(grid, clamped(middle[0] + x, 0), clamped(middle[1] + y, 1),
                                  clamped(middle[2] + z, 2));
      }
    }
  }
  for (; count < places.size(); ++count) places[count] = places[26];
  return places;
}

[[nodiscard]] inline float greater_of(float a, float b) noexcept { return a > b ? a : b; }
[[nodiscard]] inline float lesser_of(float a, float b) noexcept { return a < b ? a : b; }

/// The middle of a triangle along an axis.
[[nodiscard]] inline float middle_of(float a, float b, float c) noexcept {
  return ((a + b) + c) * (1.0F / 3);
}

/// The motion of one cluster's triangles to a field.
struct BallTurn {
  float rotation[3][3], translation[3];

  BallTurn(const TriangleCluster& cluster, const NodeBlock& nodes, std::size_t lane,
           const BallPose& pose) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& r = pose.rotation[i];
      for (std::size_t k = 0; k < 3; ++k) {
        rotation[i][k] =
            ((r[0] * cluster.axis[0][k] + r[1] * cluster.axis[1][k]) + r[2] * cluster.axis[2][k]) *
            pose.scale;
      }
      const float x = nodes.centre[0][lane] * pose.scale, y = nodes.centre[1][lane] * pose.scale,
                  z = nodes.centre[2][lane] * pose.scale;
      translation[i] = ((r[0] * x + r[1] * y) + r[2] * z) + pose.translation[i];
    }
  }
};

}  // namespace ist
