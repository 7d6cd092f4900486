#pragma once

#include <array>
#include <cstdint>

namespace ist {

/// The smallest ball round the cubes of an octree node's children, in units of h/6 from the node's
/// centre, h half the node's edge. In these units all numbers are integers: centres are 0, ±2 or
/// ±3, and the five squared radii are 27, 54, 81, 96 and 108.
struct TableBall {
  std::int8_t x = 0, y = 0, z = 0;
  std::uint8_t radius_squared = 0;

  friend constexpr bool operator==(const TableBall&, const TableBall&) = default;
};

/// The balls by occupancy mask. Entry 0, for a node without children, is a ball of radius 0.
using LookupTable = std::array<TableBall, 256>;

/// The lookup table, computed at compile time in lookup_table.cpp and proven there in integers:
/// every ball holds its cubes, no smaller ball does, and the table has the 48 symmetries of the
/// cube.
extern const LookupTable kLookupTable;

/// The table's radii by occupancy mask, in half edges of the node, as floats rounded up.
extern const std::array<float, 256> kMaskRadii;

/// √3, rounded up: the circumradius of a cube over half its edge.
inline constexpr double kSqrt3 = 1.7320508075688774;

/// The square roots of TableBall::radius_squared / 36, rounded up: radii in half edges of the node.
inline constexpr struct TableRadii {
  [[nodiscard]] constexpr double operator[](int radius_squared) const noexcept {
    switch (radius_squared) {
      case 27:
        return 0.8660254037844387;  // √3/2
      case 54:
        return 1.2247448713915892;  // √6/2
      case 81:
        return 1.5;
      case 96:
        return 1.632993161855452;  // √24/3
      default:
        return kSqrt3;
    }
  }
} kTableRadii;

}  // namespace ist
