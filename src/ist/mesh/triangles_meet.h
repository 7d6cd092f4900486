#pragma once

#include <Eigen/Core>
#include <array>

#include "ist/base/api.h"

namespace ist {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Tests whether two closed triangles have a point in common, exactly: a common boundary point
/// counts, and a triangle without area is the segment or point that remains of it. Coordinates as
/// for orientation.
///
/// Cost: 20 ns where a plane separates them or a corner is in both, 50 to 200 ns otherwise, some µs
/// where they lie in one plane. Allocates nothing.
[[nodiscard]] IST_LOOP_API bool triangles_meet(const TriangleCorners& a,
                                               const TriangleCorners& b) noexcept;

/// Tests exactly whether two triangles with the same first corner have another point in common.
/// Both must have area.
[[nodiscard]] bool fans_meet(const TriangleCorners& a, const TriangleCorners& b) noexcept;

/// Tests exactly whether the corners of a triangle do not lie on one line.
[[nodiscard]] bool has_area(const TriangleCorners& triangle) noexcept;

}  // namespace ist
