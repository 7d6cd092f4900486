#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist {

/// Triangulates a polygon of n corners into n - 2 triangles of the same orientation, appended to
/// `out`: as a fan if convex, by ear clipping if not. A polygon that is not plane is cut as seen
/// along its normal (Newell's); a self-intersecting one gets n - 2 triangles too. `corners` are
/// indices of `vertices`.
///
/// Cost: O(n) if convex; else mostly O(n^2), at worst O(n^3).
/// Source: G. H. Meisters, Polygons Have Ears, 1975.
void triangulate(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices,
                 std::vector<Triangle>& out);
/// Triangulates as triangulate() does, and avoids diagonals that are not free: it cuts the first
/// ear whose diagonal is free, or the first ear if there is none. Cost: mostly O(n^2), at worst
/// O(n^3).
void triangulate_avoiding(std::span<const std::uint32_t> corners,
                          std::span<const Eigen::Vector3d> vertices,
                          const std::function<bool(std::uint32_t, std::uint32_t)>& is_free,
                          std::vector<Triangle>& out);

}  // namespace ist
