#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// Cuts a polygon of n corners into n - 2 triangles of the same orientation, appended to `out`:
/// round the first corner where it is convex, by clipping ears where it is not. A polygon that is
/// not plane is cut as it looks along its normal (Newell's); one that crosses itself gets triangles
/// all the same. `corners` are indices of `vertices`.
///
/// Cost: O(n) where convex, O(n^2) by habit and O(n^3) at worst where not.
/// Source: G. H. Meisters, Polygons Have Ears, 1975.
void triangulate(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices,
                 std::vector<Triangle>& out);

}  // namespace ist
