#pragma once

#include "ist/tree/outer_balls.h"
#include "ist/tree/tree_stream.h"

namespace ist {

// Outer balls in a tree file:
//
//     f64 × 3, f64        the middle, the unit
//     f32, f32 × 3        the edge of a cell, half of the box; units
//     u32 × 3, u32        groups along each axis; balls
//     i32 …, u32 × 2 …    the groups' first balls; the balls

/// Writes outer balls.
void write_outer_balls(TreeWriter& writer, const OuterBalls& field);

/// Reads outer balls. Their numbers may be trusted only after verify_outer_balls().
[[nodiscard]] OuterBalls read_outer_balls(TreeReader& reader);

/// Verifies that all places are in range and all numbers finite. Whether balls are empty and
/// outside is not verified.
void verify_outer_balls(const TreeReader& reader, const OuterBalls& field);

}  // namespace ist
