#include "ist/mesh/self_intersections.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ist/base/cancellation.h"
#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/mesh/components.h"
#include "ist/mesh/orientation.h"
#include "ist/mesh/triangles_meet.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using Pair = std::array<std::uint32_t, 2>;

// Clusters between two looks at the number of pairs, and those of one task.
constexpr std::size_t kAtOnce = 1024, kGrain = 8;
// Of one cluster with more pairs the search ends.
constexpr std::size_t kMostOfACluster = 1 << 16;

// The boxes of a cluster's triangles, side by side, rounded outward.
struct alignas(64) Boxes {
  float low[3][kClusterWidth], high[3][kClusterWidth];
};

float above(double x) {
  return static_cast<float>(x + std::abs(x) * 0x1p-22) + std::numeric_limits<float>::min();
}

// Returns whether two triangles at the edge (u, v), of one plane, lie on one side of it.
bool folds_over(const Vector& u, const Vector& v, const Vector& a, const Vector& b) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = (axis + 1) % 3, j = (axis + 2) % 3;
    const auto shadow = [i, j](const Vector& p) { return Eigen::Vector2d(p[i], p[j]); };
    const int side = orientation(shadow(u), shadow(v), shadow(a));
    if (side != 0) return side == orientation(shadow(u), shadow(v), shadow(b));
  }
  return false;  // no area
}

// Both triangles, the corners that they share first, in one order.
struct Neighbours {
  TriangleCorners a, b;
  int shared = 0;
};

Neighbours neighbours_of(const TriangleMesh& mesh, Triangle a, Triangle b) {
  Neighbours out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto begin = static_cast<std::size_t>(out.shared);
    const auto same = std::find(b.begin() + out.shared, b.end(), a[i]);
    if (same == b.end()) continue;
    std::swap(a[begin], a[i]);
    std::swap(b[begin], *same);
    ++out.shared;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    out.a[i] = mesh.vertices[a[i]];
    out.b[i] = mesh.vertices[b[i]];
  }
  return out;
}

bool meet_beyond_shared(const TriangleMesh& mesh, const Triangle& first, const Triangle& second) {
  const auto [a, b, shared] = neighbours_of(mesh, first, second);
  switch (shared) {
    case 0:
      return triangles_meet(a, b);
    case 1:
      return fans_meet(a, b);
    case 2:
      return orientation(a[0], a[1], a[2], b[2]) == 0 && folds_over(a[0], a[1], a[2], b[2]);
    default:
      return true;  // one triangle twice
  }
}

class Search {
 public:
  Search(const TriangleMesh& mesh, const TriangleClusters& clusters)
      : mesh_(mesh),
        clusters_(clusters),
        boxes_(clusters.node_count(0)),
        has_area_(mesh.triangles.size()) {
    const NodeBlock& root = clusters.bounds(clusters.root_level())[0];
    double extent = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      extent = std::max(extent, std::abs(double{root.centre[i][0]}) + double{root.half[i][0]});
    }
    slack_ = rounded_up(0x1p-21 * extent);
    parallel_for(boxes_.size(), kGrain, [this](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) put_boxes(static_cast<std::uint32_t>(k));
    });
  }

  // Lists the pairs of a cluster's triangles with those of the same or a later cluster.
  void list_pairs(std::uint32_t cluster, std::vector<Pair>& out) const {
    struct Node {
      std::uint32_t index;
      int level;
    };
    constexpr std::size_t kMostLevels = 8;
    std::array<Node, kMostLevels * kClusterWidth> stack;
    std::size_t size = 0;
    stack[size++] = {0, clusters_.root_level()};
    const NodeBlock& own = clusters_.bounds(0)[cluster / kClusterWidth];
    while (size > 0) {
      const Node node = stack[--size];
      if (node.level == 0) {
        compare(cluster, node.index, out);
        if (out.size() > kMostOfACluster) return;
        continue;
      }
      const int level = node.level - 1;
      const std::uint32_t children = (1U << clusters_.child_count(level, node.index)) - 1;
      const std::uint32_t near =
          lanes_near(own, cluster % kClusterWidth, clusters_.bounds(level)[node.index]);
      for (std::uint32_t bits = near & children; bits != 0; bits &= bits - 1) {
        const std::uint32_t child =
            kClusterWidth * node.index + static_cast<std::uint32_t>(std::countr_zero(bits));
        // The last cluster below this child.
        const std::uint64_t last = ((std::uint64_t{child} + 1) << (4 * level)) - 1;
        if (last >= cluster) stack[size++] = {child, level};
      }
    }
  }

 private:
  void put_boxes(std::uint32_t cluster) {
    Boxes& boxes = boxes_[cluster];
    for (std::size_t k = 0; k < kClusterWidth; ++k) {
      const std::uint32_t id = clusters_.clusters()[cluster].id[k];
      const Triangle& t = mesh_.triangles[id];
      const TriangleCorners corners = {mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                       mesh_.vertices[t[2]]};
      if (k < clusters_.child_count(-1, cluster)) {
        has_area_[id] = !has_equal_indices(t) && has_area(corners);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const double origin = clusters_.origin()[axis];
        const double x = corners[0][axis] - origin, y = corners[1][axis] - origin,
                     z = corners[2][axis] - origin;
        boxes.low[i][k] = -above(-std::min({x, y, z}));
        boxes.high[i][k] = above(std::max({x, y, z}));
      }
    }
  }

  [[nodiscard]] std::uint32_t lanes_near(const NodeBlock& own, std::size_t at,
                                         const NodeBlock& block) const {
    std::uint32_t bits = 0;
    alignas(64) float apart[kClusterWidth];
    for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
      float most = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(block.centre[i][lane] - own.centre[i][at]) -
                                  (block.half[i][lane] + own.half[i][at]));
      }
      apart[lane] = most;
    }
    for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
      bits |= static_cast<std::uint32_t>(!(apart[lane] > slack_)) << lane;
    }
    return bits;
  }

  void compare(std::uint32_t one, std::uint32_t other, std::vector<Pair>& out) const {
    if (other < one) return;
    const Boxes &a = boxes_[one], &b = boxes_[other];
    const std::uint32_t count = clusters_.child_count(-1, other);
    for (std::uint32_t k = 0; k < clusters_.child_count(-1, one); ++k) {
      const std::uint32_t first = clusters_.clusters()[one].id[k];
      if (has_area_[first] == 0) continue;
      alignas(64) float apart[kClusterWidth];
      for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
        float most = -std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < 3; ++i) {
          most = std::max(most,
                          std::max(b.low[i][lane] - a.high[i][k], a.low[i][k] - b.high[i][lane]));
        }
        apart[lane] = most;
      }
      for (std::uint32_t lane = one == other ? k + 1 : 0; lane < count; ++lane) {
        if (apart[lane] > 0) continue;
        const std::uint32_t second = clusters_.clusters()[other].id[lane];
        if (has_area_[second] == 0) continue;
        if (meet_beyond_shared(mesh_, mesh_.triangles[first], mesh_.triangles[second])) {
          out.push_back({std::min(first, second), std::max(first, second)});
        }
      }
    }
  }

  const TriangleMesh& mesh_;
  const TriangleClusters& clusters_;
  std::vector<Boxes> boxes_;
  std::vector<std::uint8_t> has_area_;  // of each triangle; threads write neighbours
  float slack_ = 0;                     // more than the rounding of a node's bounds
};

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          const TriangleClusters& clusters) {
  const Search search(mesh, clusters);
  SelfIntersections found;
  const std::size_t count = clusters.node_count(0);
  for (std::size_t done = 0; done < count && found.complete; done += kAtOnce) {
    cancellation_point();
    std::vector<std::vector<Pair>> pairs(std::min(kAtOnce, count - done));
    parallel_for(pairs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        search.list_pairs(static_cast<std::uint32_t>(done + k), pairs[k]);
      }
    });
    for (const std::vector<Pair>& some : pairs) {
      if (!found.complete) break;
      found.pairs.insert(found.pairs.end(), some.begin(), some.end());
      found.complete =
          some.size() <= kMostOfACluster && found.pairs.size() <= SelfIntersections::kMost;
    }
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  if (found.pairs.size() > SelfIntersections::kMost) found.pairs.resize(SelfIntersections::kMost);
  return found;
}

}  // namespace ist
