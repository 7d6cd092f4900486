#include "ist/measure/inside_parts.h"

#include <algorithm>
#include <cmath>

namespace ist {

bool is_any_inside(const SurfaceInBody& side) {
  const LeafTriangles& body = *parts_of(side.body).triangles;
  const auto& points = parts_of(side.surface).triangles->component_points();
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = side.to_body(point);
    if (body.sides().is_beyond(at)) return false;
    const auto nearest = side.search.nearest(at, HUGE_VAL);
    return nearest && body.side_of(at, *nearest) == Side::kInside;
  });
}

}  // namespace ist
