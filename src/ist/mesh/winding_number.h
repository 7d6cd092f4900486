#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "ist/mesh/triangle_mesh.h"

namespace ist {

/// How often some triangles of a mesh wind round a point, by a ray from it: what it crosses, out
/// less in. The direction is changed while the ray meets an edge; all of them do only from a point
/// on the surface, for which there is no answer. Where the triangles do not enclose the point, it
/// is what the ray meets.
///
/// Cost: 5 ns a triangle. Allocates nothing.
[[nodiscard]] std::optional<int> winding_number(const TriangleMesh& mesh,
                                                std::span<const std::uint32_t> triangles,
                                                const Eigen::Vector3d& point) noexcept;

}  // namespace ist
