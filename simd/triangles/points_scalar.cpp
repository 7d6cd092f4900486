#include "simd/triangles/points_scalar.h"

#include <algorithm>
#include <cmath>

#include "simd/triangles/triangle_lanes.h"

namespace ist {
namespace {

// The distance from the box round a node, and from its disc: the larger of both.
float bound_node(const NodeBlock& nodes, std::size_t lane, const TreePoint& point) {
  LanePoint v, normal;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = (point.at[i] - nodes.centre[i][lane]) + point.rest[i];
    normal[i] = nodes.normal[i][lane];
  }
  const float slack = point.error + kPointRounding * (size(v) + nodes.radius[lane]);
  LanePoint gap;
  for (std::size_t i = 0; i < 3; ++i) {
    gap[i] = std::max((std::abs(v[i]) - nodes.half[i][lane]) - slack, 0.0F);
  }
  const float along = dot(normal, v), square = dot(v, v);
  const float above =
      std::max((std::abs(along - nodes.offset[lane]) - nodes.thickness[lane]) - slack, 0.0F);
  const float across = (square - along * along) - (2 * kPointRounding) * square;
  const float beside =
      std::max((std::sqrt(std::max(across, 0.0F)) - nodes.rim[lane]) - slack, 0.0F);
  return std::max(dot(gap, gap), above * above + beside * beside) * (1 - kPointRounding);
}

// Bounds of the square of a distance.
struct SquareBounds {
  float least, most;
};

// A point of the triangle bounds the distance from above. From below does the plane through it, at
// right angles to the way from there to `p`: where no corner lies before that plane, no point of
// the triangle does. It should be the nearest point, and need not be.
SquareBounds bound_triangle(const LaneTriangle& t, const LanePoint& p, float error) {
  LanePoint from[3], edge[3], way{};
  float length[3];  // squares
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = p - t[i];
    edge[i] = t[(i + 1) % 3] - t[i];
    length[i] = dot(edge[i], edge[i]);
  }
  float square = HUGE_VALF, more = error;
  for (std::size_t i = 0; i < 3; ++i) {
    const float along = dot(from[i], edge[i]) / std::max(length[i], kLeastSquare);
    const float part = std::min(std::max(along, 0.0F), 1.0F);
    LanePoint here;
    for (std::size_t k = 0; k < 3; ++k) here[k] = from[i][k] - part * edge[i][k];
    if (!(dot(here, here) < square)) continue;
    square = dot(here, here);
    way = here;
  }
  const LanePoint normal = cross(edge[0], edge[1]);
  const float area = dot(normal, normal);
  const float side =
      std::min(std::min(dot(cross(edge[0], from[0]), normal), dot(cross(edge[1], from[1]), normal)),
               dot(cross(edge[2], from[2]), normal));
  const float sharpest =
      std::max(std::max(length[0] * length[1], length[1] * length[2]), length[2] * length[0]);
  if (side > 0 && area > std::max(sharpest * kPlaneSine, kLeastSquare)) {
    const float height = dot(from[0], normal) / area;
    for (std::size_t k = 0; k < 3; ++k) way[k] = height * normal[k];
    square = dot(way, way);
    more = kPlaneError * error;
  }
  const float first = std::min(std::min(dot(way, from[0]), dot(way, from[1])), dot(way, from[2]));
  const float least = first / std::sqrt(std::max(square, kLeastSquare)) - error;
  const float most = std::sqrt(square) + more;
  return {least > 0 ? (least * least) * (1 - kPointRounding) : 0,
          (most * most) * (1 + kPointRounding)};
}

}  // namespace

std::uint32_t near_nodes_scalar(const NodeBlock& nodes, const TreePoint& point, float far,
                                float* squares) {
  std::uint32_t near = 0;
  for (std::uint32_t lane = 0; lane < kClusterWidth; ++lane) {
    squares[lane] = bound_node(nodes, lane, point);
    if (!(squares[lane] > far)) near |= std::uint32_t{1} << lane;
  }
  return near;
}

std::uint32_t near_triangles_scalar(const TriangleCluster& cluster, const ClusterPoint& point,
                                    float& far, float* squares) {
  const float unit = point.unit, back = (1 / unit) * (1 / unit);
  const LanePoint p = {point.at[0] * unit, point.at[1] * unit, point.at[2] * unit};
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    LaneTriangle t;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t i = 0; i < 3; ++i) t[corner][i] = cluster.corner[corner][i][lane] * unit;
    }
    const SquareBounds bounds = bound_triangle(t, p, point.error * unit);
    squares[lane] = bounds.least * back;
    const float most = bounds.most * back + kSquareUnderflow;
    if (most < far) far = most;
  }
  std::uint32_t near = 0;
  for (std::uint32_t lane = 0; lane < kClusterWidth; ++lane) {
    if (!(squares[lane] > far)) near |= std::uint32_t{1} << lane;
  }
  return near;
}

}  // namespace ist
