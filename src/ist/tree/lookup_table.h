#pragma once

#include <array>
#include <cstdint>

namespace ist {

/// The smallest ball that holds the children's cubes of an octree node, in units of h/6 from the
/// node's centre, h half the node's edge. In these units all is integer: centres are 0, ±2 or ±3,
/// and the five squared radii are 27, 54, 81, 96 and 108.
struct TableBall {
  std::int8_t x = 0, y = 0, z = 0;
  std::uint8_t radius_squared = 0;

  friend constexpr bool operator==(const TableBall&, const TableBall&) = default;
};

/// Ball by occupancy mask. Entry 0, a node without children, is a ball of radius 0.
using LookupTable = std::array<TableBall, 256>;

namespace lookup_table_detail {

struct Point {
  int x, y, z;
};

// The 27 corners that the eight children's cubes have among them: coordinates -6, 0 and 6.
constexpr Point corner(int i) { return {6 * (i % 3 - 1), 6 * (i / 3 % 3 - 1), 6 * (i / 9 - 1)}; }

// Bit i says that corner i belongs to the cube of a child in `mask`.
constexpr std::uint32_t corners_of(int mask) {
  std::uint32_t corners = 0;
  for (int octant = 0; octant < 8; ++octant) {
    if ((mask >> octant & 1) == 0) continue;
    for (int c = 0; c < 8; ++c) {
      const int x = (octant & 1) + (c & 1), y = (octant >> 1 & 1) + (c >> 1 & 1);
      corners |= 1u << (x + 3 * y + 9 * ((octant >> 2) + (c >> 2)));
    }
  }
  return corners;
}

constexpr int distance_squared(Point p, Point q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z);
}

// That the best centre is one of these 125 needs no proof here: lookup_table.cpp proves of each
// result that no ball is smaller.
constexpr TableBall smallest_ball(int mask) {
  constexpr int kCoordinates[] = {0, -2, 2, -3, 3};
  const std::uint32_t corners = corners_of(mask);
  TableBall best;
  int best_squared = 1 << 20;
  for (const int x : kCoordinates) {
    for (const int y : kCoordinates) {
      for (const int z : kCoordinates) {
        int farthest = 0;
        for (int i = 0; i < 27 && farthest < best_squared; ++i) {
          if ((corners >> i & 1) == 0) continue;
          const int squared = distance_squared(corner(i), {x, y, z});
          farthest = squared > farthest ? squared : farthest;
        }
        if (farthest >= best_squared) continue;
        best_squared = farthest;
        best = {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y),
                static_cast<std::int8_t>(z), static_cast<std::uint8_t>(farthest)};
      }
    }
  }
  return best;
}

constexpr LookupTable make_lookup_table() {
  LookupTable table{};
  for (int mask = 1; mask < 256; ++mask) {
    table[static_cast<std::size_t>(mask)] = smallest_ball(mask);
  }
  return table;
}

}  // namespace lookup_table_detail

/// Proven in lookup_table.cpp, at compile time and in integers: every ball holds its cubes, none
/// could be smaller, and the table has the 48 symmetries of the cube.
inline constexpr LookupTable kLookupTable = lookup_table_detail::make_lookup_table();

}  // namespace ist
