#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "ist/mesh/mesh.h"

namespace ist {

/// Returns the winding number of some triangles of a mesh round a point: outward minus inward
/// crossings of a ray from the point. The ray takes another direction if it hits an edge. Returns
/// nullopt if all directions do, as happens only for a point on the surface. For an open surface
/// the result depends on the ray's direction.
///
/// Cost: 5 ns a triangle. Allocates nothing.
[[nodiscard]] std::optional<int> winding_number(const TriangleMesh& mesh,
                                                std::span<const std::uint32_t> triangles,
                                                const Eigen::Vector3d& point) noexcept;

}  // namespace ist
