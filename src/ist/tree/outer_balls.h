#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ist {

/// A ball in the units of its field: three 16-bit coordinates of the centre, and a radius, 0 …
/// 65535.
struct OuterBall {
  std::int32_t xy = 0, zr = 0;

  OuterBall() = default;
  OuterBall(const std::array<std::int32_t, 3>& at, std::uint32_t radius) noexcept
      : xy(packed(at[0], static_cast<std::uint32_t>(at[1]))), zr(packed(at[2], radius)) {}

  [[nodiscard]] std::int32_t x() const noexcept { return static_cast<std::int16_t>(xy); }
  [[nodiscard]] std::int32_t y() const noexcept { return xy >> 16; }
  [[nodiscard]] std::int32_t z() const noexcept { return static_cast<std::int16_t>(zr); }
  [[nodiscard]] std::uint32_t radius() const noexcept {
    return static_cast<std::uint32_t>(zr) >> 16;
  }
  /// The largest coordinate, and the largest radius.
  static constexpr std::int32_t kMostCoordinate = 32767;
  static constexpr std::uint32_t kMostRadius = 65535;

  friend bool operator==(const OuterBall&, const OuterBall&) = default;

 private:
  static std::int32_t packed(std::int32_t low, std::uint32_t high) noexcept {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(low) & 0xFFFFU) | high << 16);
  }
};
static_assert(sizeof(OuterBall) == 8);

/// A field of outer balls: a grid round a body, and for each cell a ball. The interior of a ball
/// holds no point of the surface. If the body is closed, the interior lies outside the body. So no
/// point p lies deeper in the body than |p - centre| - radius, for each ball and wherever p is. The
/// choice of a ball changes the time alone.
///
/// Lengths are multiples of `unit`, a power of two, about `middle`. Balls are whole numbers of it.
struct OuterBalls {
  /// Cells along each axis of a group of cells. A group away from the surface has one ball.
  static constexpr std::uint32_t kGroup = 4;
  static constexpr std::uint32_t kGroupCells = kGroup * kGroup * kGroup;

  Eigen::Vector3d middle{0, 0, 0};        ///< mesh coordinates
  double unit = 1;                        ///< mesh units
  float cell = 1;                         ///< the edge of a cell
  std::array<float, 3> half{};            ///< of the box round the surface, or more
  std::array<std::uint32_t, 3> groups{};  ///< along each axis
  std::vector<std::int32_t> first = {};   ///< of each group: 2 · its first ball, + 1 if one a cell
  std::vector<OuterBall> balls = {};

  [[nodiscard]] std::size_t bytes() const noexcept {
    return first.capacity() * sizeof(first[0]) + balls.capacity() * sizeof(balls[0]);
  }
  /// The least coordinate of the grid along an axis.
  [[nodiscard]] float low(std::size_t axis) const noexcept {
    return -0.5F * (static_cast<float>(kGroup * groups[axis]) * cell);
  }
  /// Returns the place of a cell's ball in `balls`. Precondition: the cell is in the grid.
  [[nodiscard]] std::uint32_t ball_at(std::uint32_t x, std::uint32_t y,
                                      std::uint32_t z) const noexcept {
    const std::size_t group =
        (std::size_t{z / kGroup} * groups[1] + y / kGroup) * groups[0] + x / kGroup;
    const auto entry = static_cast<std::uint32_t>(first[group]);
    const std::uint32_t within = ((z % kGroup) * kGroup + y % kGroup) * kGroup + x % kGroup;
    return (entry >> 1) + ((entry & 1U) != 0 ? within : 0);
  }
  /// Returns a bound of the depth of a point, mesh coordinates, by the ball of its cell: rounded,
  /// |p - centre| - radius. It is negative in the ball.
  [[nodiscard]] double bound_at(const Eigen::Vector3d& point) const noexcept {
    const double to_units = 1 / unit, to_cells = 1 / double{cell};
    double at[3];
    std::uint32_t place[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      at[i] = (point[axis] - middle[axis]) * to_units;
      const double inside = (at[i] - double{low(i)}) * to_cells;
      const std::uint32_t last = kGroup * groups[i] - 1;
      place[i] = !(inside > 0) ? 0 : inside < last ? static_cast<std::uint32_t>(inside) : last;
    }
    const OuterBall& ball = balls[ball_at(place[0], place[1], place[2])];
    const double x = at[0] - ball.x(), y = at[1] - ball.y(), z = at[2] - ball.z();
    return (std::sqrt((x * x + y * y) + z * z) - ball.radius()) * unit;
  }
};

}  // namespace ist
