#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace ist {

/// Returns the indices of triangles, given by three corners each, in an order in which neighbours
/// are close: any 16, 256, 4096 … that follow each other from a multiple of that number on lie in a
/// compact part of the mesh. The triangles are halved along the longest axis of their centres, at a
/// multiple of the largest such number, again and again. Centres are compared as floats. The same
/// on every machine. Cost: 0.12 µs a triangle and core.
[[nodiscard]] std::vector<std::uint32_t> triangle_order(std::span<const Eigen::Vector3d> corners);

}  // namespace ist
