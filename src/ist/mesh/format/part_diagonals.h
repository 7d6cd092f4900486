#pragma once

#include <cstdint>
#include <span>

#include "ist/mesh/mesh.h"

namespace ist {

/// Triangulates a polygon again if another polygon uses one of its diagonals as an edge. Two quads
/// that share opposite corners may have the same diagonal. Then four triangles meet in it, and a
/// closed surface has a doubled triangle. Most polygons have another diagonal.
///
/// @param polygons for each polygon: its number of corners n, then the corners' vertices in the
/// mesh
/// @param mesh has n - 2 triangles for each polygon, in order; keeps that order
/// Cost: O(t log t) for t triangles, and triangulate_avoiding() for each polygon with such a
/// diagonal, at most twice.
void part_diagonals(std::span<const std::uint32_t> polygons, TriangleMesh& mesh);

}  // namespace ist
