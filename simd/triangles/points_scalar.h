#pragma once

#include "simd/triangles/point_step.h"

namespace ist {

/// The scalar forms of the kernels, which specify the vector forms.
std::uint32_t near_nodes_scalar(const NodeBlock& nodes, const TreePoint& point, float far,
                                float* squares);
std::uint32_t near_triangles_scalar(const TriangleCluster& cluster, const ClusterPoint& point,
                                    float& far, float* squares);

}  // namespace ist
