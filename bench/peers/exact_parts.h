#pragma once

#include <Eigen/Geometry>

#include "ist/mesh/triangles_meet.h"

namespace ist::bench {

// What contestants share that decide exactly: the arithmetic by which IST's pairs are defined, so
// that all name the same ones. It stands in the program, where no multiply and add is fused;
// contestants may be compiled otherwise.

/// A triangle where a rigid motion puts it, each coordinate rounded as Query::triangle_pairs()
/// rounds it.
[[nodiscard]] TriangleCorners moved(const Eigen::Isometry3d& rigid,
                                    const TriangleCorners& triangle) noexcept;

/// triangles_meet(), which a library outside of the program does not see.
[[nodiscard]] bool meet(const TriangleCorners& a, const TriangleCorners& b) noexcept;

}  // namespace ist::bench
