#pragma once

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Adds 4 * `quarter` vertices on the circle of that radius round the z axis, at height z, from the
/// x axis on and counterclockwise; returns the first one. They are placed by Pythagorean triples
/// rather than by a sine, so that they are the same bits everywhere; two neighbours are at most
/// 2/`quarter` radians apart.
std::uint32_t add_ring(TriangleMesh& mesh, int quarter, double radius, double z);

/// Joins two such rings by triangles. Their outer side is where one sees the first ring go to the
/// right and the second one above it.
void add_band(TriangleMesh& mesh, int quarter, std::uint32_t below, std::uint32_t above);

}  // namespace ist
