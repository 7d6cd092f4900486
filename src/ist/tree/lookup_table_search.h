#pragma once

#include "ist/tree/lookup_table.h"

/// Computes the lookup table: at compile time for lookup_table.cpp, which proves the result, and at
/// run time for a benchmark.
namespace ist {

namespace lookup_table_detail {

struct Point {
  int x, y, z;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

// Returns one of the 27 corners of the eight children's cubes: coordinates -6, 0 and 6.
constexpr Point corner(int i) { return {6 * (i % 3 - 1), 6 * (i / 3 % 3 - 1), 6 * (i / 9 - 1)}; }

// Returns a mask of corners: bit i is set if corner i belongs to the cube of a child in `mask`.
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

// Searches 125 candidate centres. lookup_table.cpp proves that no ball is smaller than the result.
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

// Returns the code of a coordinate: a sign, then a magnitude of 0, 2 or 3.
constexpr std::uint32_t code_of(int coordinate) {
  return static_cast<std::uint32_t>(coordinate < 0 ? 4 - coordinate : coordinate);
}

constexpr std::uint32_t word_of(const TableBall& ball) {
  return code_of(ball.x) | code_of(ball.y) << 3 | code_of(ball.z) << 6 |
         static_cast<std::uint32_t>(radius_code(ball)) << 9;
}

}  // namespace lookup_table_detail

}  // namespace ist
