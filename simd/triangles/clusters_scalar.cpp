#include <cmath>

#include "simd/triangles/cluster_step.h"
#include "simd/triangles/node_lanes.h"
#include "simd/triangles/points_scalar.h"
#include "simd/triangles/triangle_lanes.h"

namespace ist {
namespace {

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
    turn_nodes_scalar,     meet_nodes_scalar,    list_lanes_scalar,       meet_children_scalar,
    score_children_scalar, meet_clusters_scalar, decide_triangles_scalar, near_clusters_scalar,
    near_nodes_scalar,     near_triangles_scalar};

}  // namespace ist
