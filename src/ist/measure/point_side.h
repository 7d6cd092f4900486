#pragma once

#include "ist/base/ordered_vector.h"
#include "ist/measure/point_search.h"

namespace ist {

/// The side of a body's surface on which a point lies.
enum class Side : std::uint8_t { kOutside, kInside, kUnknown };

/// Returns whether a point lies outside the box round a closed body: then it is outside, however
/// far, where rounding would leave no nearest point to tell it by.
[[nodiscard]] inline bool is_beyond(const LeafTriangles& body,
                                    const Eigen::Vector3d& point) noexcept {
  return body.normals().closed() && !body.box().contains(point);
}

/// Returns the side that the pseudonormal tells, by the body's triangle nearest to the point.
[[nodiscard]] inline Side side_of(const LeafTriangles& body, const NearestTriangle& nearest,
                                  const Eigen::Vector3d& point) noexcept {
  if (is_beyond(body, point)) return Side::kOutside;
  const auto normal = body.normals().at(body.mesh, nearest.triangle, nearest.on);
  if (!normal) return Side::kUnknown;
  const bool inside = dot_in_order(*normal, difference(point, nearest.on.point)) < 0;
  return inside ? Side::kInside : Side::kOutside;
}

}  // namespace ist
