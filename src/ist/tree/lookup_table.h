#pragma once

#include <array>
#include <cstddef>
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

/// The lookup table in words, by occupancy mask: the codes of x, y and z in bits 2:0, 5:3 and 8:6,
/// bit 2 of each the sign and bits 1:0 the magnitude 0, 2 or 3; the radius code in bits 11:9.
extern const std::array<std::uint32_t, 256> kTableWords;

/// The table's squared radii, by radius code. The code of mask 0 is kNoRadiusCode.
inline constexpr std::array<int, 5> kTableSquares = {27, 54, 81, 96, 108};
inline constexpr std::size_t kNoRadiusCode = 7, kCircumsphereCode = 4;

[[nodiscard]] constexpr std::size_t radius_code(const TableBall& ball) noexcept {
  for (std::size_t code = 0; code < kTableSquares.size(); ++code) {
    if (kTableSquares[code] == ball.radius_squared) return code;
  }
  return kNoRadiusCode;
}

/// √3, rounded up: the circumradius of a cube over half its edge.
inline constexpr double kSqrt3 = 1.7320508075688774;

/// The table's radii by radius code, in half edges of the node, rounded up: the roots of
/// kTableSquares / 36, which are √3/2, √6/2, 3/2, √24/3 and √3.
inline constexpr std::array<double, 5> kTableRadii = {0.8660254037844387, 1.2247448713915892, 1.5,
                                                      1.632993161855452, kSqrt3};

/// How far the circumsphere of a leaf sticks out of the table ball of a node above it, at most, in
/// 1e-4 voxels: by the node's level, 1 or 2, and radius code; above level 2 by no more than there.
/// Proven at compile time in lookup_table.cpp; docs/guarantees.md, Nested bounds, says why it
/// falls.
inline constexpr std::array<std::array<int, 5>, 2> kLeafExcess = {
    {{0, 1413, 732, 991, 0}, {0, 749, 455, 665, 0}}};

/// Returns what a table ball lacks of the circumspheres of all leaves below its node, in voxels.
[[nodiscard]] constexpr double leaf_excess(int level, std::size_t radius_code) noexcept {
  return level == 0 ? 0 : 1e-4 * kLeafExcess[level == 1 ? 0 : 1][radius_code];
}

}  // namespace ist
