#include "ist/measure/inside_parts.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {

bool is_any_inside(const SurfaceInBody& side) {
  const LeafTriangles& body = *side.body.parts().triangles;
  const auto& points = side.surface.parts().triangles->component_points();
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d at = side.to_body(point);
    const NearestTriangle nearest = *side.search.nearest(at, HUGE_VAL);
    const auto normal = body.normals().at(body.mesh, nearest.triangle, nearest.on);
    return normal && dot_in_order(*normal, difference(at, nearest.on.point)) < 0;
  });
}

}  // namespace ist
