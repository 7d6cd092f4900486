#include "ist/query/exact/nearest_beam.h"

#include <algorithm>
#include <limits>

namespace ist {
namespace {

struct NodePair {
  std::uint32_t fixed, moving;
  float score;
};

// The best pairs so far, best first; of equal ones the earlier.
struct Best {
  std::array<NodePair, kBeamWidth> pairs;
  std::size_t count = 0;

  void add(const NodePair& pair) noexcept {
    if (count == kBeamWidth && !(pair.score < pairs[count - 1].score)) return;
    std::size_t at = count < kBeamWidth ? count++ : count - 1;
    for (; at > 0 && pair.score < pairs[at - 1].score; --at) pairs[at] = pairs[at - 1];
    pairs[at] = pair;
  }
};

using Point = std::array<double, 3>;

double dot(const double (&a)[3], const Point& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// Returns the first corner of a triangle in a cluster, in the tree's frame.
Point first_corner(const TriangleClusters& clusters, std::uint32_t cluster, std::size_t lane) {
  const TriangleCluster& of = clusters.clusters()[cluster];
  const NodeBlock& block = clusters.bounds(0)[cluster / kClusterWidth];
  Point p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = block.centre[i][cluster % kClusterWidth];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[i] += double{of.axis[i][axis]} * double{of.corner[0][axis][lane]};
    }
  }
  return p;
}

// Returns the triangles of two clusters whose first corners are nearest.
TriangleIds nearest_corners(const TriangleClusters& fixed, const TriangleClusters& moving,
                            const ClusterPose& pose, const NodePair& pair) {
  std::array<Point, kClusterWidth> corners;
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    corners[lane] = first_corner(fixed, pair.fixed, lane);
  }
  TriangleIds nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < kClusterWidth; ++m) {
    const Point p = first_corner(moving, pair.moving, m);
    Point at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = dot(pose.rotation[i], p) + pose.translation[i];
    for (std::size_t f = 0; f < kClusterWidth; ++f) {
      double squared = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        squared += (at[i] - corners[f][i]) * (at[i] - corners[f][i]);
      }
      if (!(squared < least)) continue;
      least = squared;
      nearest = {fixed.clusters()[pair.fixed].id[f], moving.clusters()[pair.moving].id[m]};
    }
  }
  return nearest;
}

}  // namespace

NearestBeam::NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
                         const ClusterKernels& kernels, const ClusterPose& pose) noexcept {
  int fixed_level = fixed.root_level(), moving_level = moving.root_level();
  Best best;
  best.add({0, 0, 0});
  TurnedBlock turned;
  alignas(64) float scores[kClusterWidth];
  while (fixed_level > 0 || moving_level > 0) {
    const bool fixed_goes = fixed_level >= moving_level, moving_goes = moving_level >= fixed_level;
    Best next;
    for (std::size_t k = 0; k < best.count; ++k) {
      const NodePair pair = best.pairs[k];
      // A tree that stays has its node's siblings beside the node.
      const std::uint32_t moving_block = moving_goes ? pair.moving : pair.moving / kClusterWidth;
      const std::uint32_t fixed_block = fixed_goes ? pair.fixed : pair.fixed / kClusterWidth;
      const int below_moving = moving_level - (moving_goes ? 1 : 0);
      const int below_fixed = fixed_level - (fixed_goes ? 1 : 0);
      kernels.turn_nodes(moving.bounds(below_moving)[moving_block], pose, turned);
      for (std::uint32_t m = 0; m < moving.child_count(below_moving, moving_block); ++m) {
        const std::uint32_t moving_node = kClusterWidth * moving_block + m;
        if (!moving_goes && moving_node != pair.moving) continue;
        kernels.score_children(turned, m, fixed.bounds(below_fixed)[fixed_block], scores);
        for (std::uint32_t f = 0; f < fixed.child_count(below_fixed, fixed_block); ++f) {
          const std::uint32_t fixed_node = kClusterWidth * fixed_block + f;
          if (!fixed_goes && fixed_node != pair.fixed) continue;
          next.add({fixed_node, moving_node, scores[f]});
        }
      }
    }
    best = next;
    fixed_level -= fixed_goes ? 1 : 0;
    moving_level -= moving_goes ? 1 : 0;
  }
  count_ = best.count;
  for (std::size_t k = 0; k < count_; ++k) {
    ids_[k] = nearest_corners(fixed, moving, pose, best.pairs[k]);
  }
}

}  // namespace ist
