#include <algorithm>
#include <cmath>

#include "simd/triangles/cluster_step.h"
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

// The scalar forms of the kernels, which specify the vector forms.
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

void turn_nodes_scalar(const NodeBlock& moving, const ClusterPose& pose, TurnedBlock& out) {
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    const auto turned = [&](std::size_t i, const float(&v)[3][kClusterWidth]) {
      const auto& r = pose.rotation[i];
      return (r[0] * double{v[0][lane]} + r[1] * double{v[1][lane]}) + r[2] * double{v[2][lane]};
    };
    const float offset = moving.offset[lane], thickness = moving.thickness[lane];
    const float rim = moving.rim[lane];
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = turned(i, moving.centre) + pose.translation[i];
      const auto centre = static_cast<float>(std::nearbyint(at * (1 / pose.grid)) * pose.grid);
      out.centre[i][lane] = centre;
      out.rest[i][lane] = static_cast<float>(at - double{centre});
      const auto normal = static_cast<float>(turned(i, moving.normal));
      out.normal[i][lane] = normal;
      const auto width = [&](std::size_t axis) {
        return static_cast<float>(std::abs(pose.rotation[i][axis])) * moving.half[axis][lane];
      };
      const float box = (width(0) + width(1)) + width(2), middle = offset * normal;
      const float disc = thickness * std::abs(normal) + rim * sine_of(normal);
      out.low[i][lane] = std::max(0 - box, middle - disc);
      out.high[i][lane] = std::min(box, middle + disc);
    }
    out.offset[lane] = offset;
    out.thickness[lane] = thickness;
    out.rim[lane] = rim;
    out.radius[lane] = moving.radius[lane];
  }
}

void meet_nodes_scalar(const TurnedBlock& lanes, std::uint32_t lane_count, const FixedNodes& fixed,
                       LaneNodes nodes, float reach, std::uint32_t* bits) {
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const std::uint32_t node = nodes.node(k);
    const NodeLane one(fixed.blocks[node / kClusterWidth], node % kClusterWidth);
    bits[k] = 0;
    for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
      if (may_be_near(one, NodeLane(lanes, lane), reach)) bits[k] |= std::uint32_t{1} << lane;
    }
  }
}

std::size_t list_lanes_scalar(LaneNodes nodes, const std::uint32_t* bits, std::uint32_t* out) {
  std::size_t found = 0;
  for (std::uint32_t lane = 0; lane < kClusterWidth; ++lane) {
    for (std::size_t k = 0; k < nodes.count; ++k) {
      if (bits[k] >> lane & 1U) out[found++] = kClusterWidth * nodes.node(k) + lane;
    }
  }
  return found;
}

std::size_t meet_children_scalar(const TurnedBlock& lanes, const FixedNodes& children,
                                 LaneNodes parents, float reach, std::uint32_t* out) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < parents.count; ++k) {
    const std::uint32_t lane = parents.lane(k), parent = parents.node(k);
    const NodeLane one(lanes, lane);
    for (std::uint32_t child = 0; child < children.children_of(parent); ++child) {
      if (!may_be_near(one, NodeLane(children.blocks[parent], child), reach)) continue;
      out[found++] = kClusterWidth * (kClusterWidth * parent + child) + lane;
    }
  }
  return found;
}

void score_children_scalar(const TurnedBlock& lanes, std::uint32_t lane, const NodeBlock& children,
                           float* scores) {
  const NodeLane one(lanes, lane);
  for (std::size_t child = 0; child < kClusterWidth; ++child) {
    const NodesApart apart(one, NodeLane(children, child));
    scores[child] = dot(apart.gap, apart.gap) + dot(apart.centre, apart.centre) * kCentreShare;
  }
}

// Calls `take(place, a, b, f, m)` for all pairs of triangles, of some pairs of clusters, whose
// boxes are within reach: in lanes f and m of their clusters.
template <class Take>
std::size_t each_pair(const ClusterStep& step, const ClusterPairs& clusters, const float& reach,
                      const FoundTriangles& out, Take take) {
  std::size_t k = 0;
  for (; k < clusters.pairs.count && out.has_room(); ++k) {
    const std::uint32_t lane = clusters.pairs.lane(k), fixed = clusters.pairs.node(k);
    const NodeLane other(step.fixed_nodes.blocks[fixed / kClusterWidth], fixed % kClusterWidth);
    const ClusterPlace place(step, NodeLane(clusters.lanes, lane), clusters.moving + lane, fixed,
                             other);
    for (std::uint32_t m = 0; m < place.moving_count(); ++m) {
      const LaneTriangle b = place.moving(m);
      for (std::uint32_t f = 0; f < place.fixed_count(); ++f) {
        const LaneTriangle a = place.fixed(f);
        if (!boxes_apart(a, b, reach + 2 * place.error())) take(place, a, b, f, m);
      }
    }
  }
  return k;
}

void take(Decision decision, TriangleIds ids, FoundTriangles& out) {
  if (decision == Decision::kMeet) out.certain.add(ids);
  if (decision == Decision::kOpen) out.open.add(ids);
}

// Decides each pair at once: the batch stays as it is.
std::size_t meet_clusters_scalar(const ClusterStep& step, const ClusterPairs& pairs,
                                 TriangleBatch& /*batch*/, FoundTriangles& out) {
  return each_pair(
      step, pairs, 0, out,
      [&](const ClusterPlace& place, const LaneTriangle& a, const LaneTriangle& b, std::uint32_t f,
          std::uint32_t m) { take(decide(a, b, place.error()), place.ids(f, m), out); });
}

void decide_triangles_scalar(TriangleBatch& batch, FoundTriangles& out) {
  for (std::size_t at = 0; at < batch.count; ++at) {
    LaneTriangle a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        a[k][i] = batch.fixed[k][i][at];
        b[k][i] = batch.moving[k][i][at];
      }
    }
    take(decide(a, b, batch.error[at]), {batch.fixed_id[at], batch.moving_id[at]}, out);
  }
  batch.count = 0;
}

std::size_t near_clusters_scalar(const ClusterStep& step, const ClusterPairs& pairs, Reach& reach,
                                 TriangleBatch& /*batch*/, FoundTriangles& out) {
  return each_pair(step, pairs, reach.triangles, out,
                   [&](const ClusterPlace& place, const LaneTriangle& a, const LaneTriangle& b,
                       std::uint32_t f, std::uint32_t m) {
                     const LaneDistance distance(a, b, place.error());
                     reach.triangles = std::min(
                         reach.triangles, nearest_of(distance.most, place.error()) + reach.margin);
                     if (distance.least > reach.triangles * reach.triangles) return;
                     out.squares[out.open.count] = distance.least;
                     out.open.add(place.ids(f, m));
                   });
}

}  // namespace

constinit const ClusterKernels kScalarClusterKernels{
    turn_nodes_scalar,     meet_nodes_scalar,     list_lanes_scalar,       meet_children_scalar,
    score_children_scalar, meet_clusters_scalar,  decide_triangles_scalar, near_clusters_scalar,
    near_nodes_scalar,     near_triangles_scalar, closest_octet_scalar,    bound_nodes_scalar,
    bound_corners_scalar,  bound_around_scalar};

}  // namespace ist
