#include "ist/mesh/self_intersections.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

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
constexpr std::size_t kAtOnce = 128, kGrain = 8;
// Of one cluster with more pairs the search ends.
constexpr std::size_t kMostOfACluster = 1 << 16;

void look_for_an_end(const Progress* progress) {
  cancellation_point();
  if (progress != nullptr) progress->check();
}

// The boxes of a cluster's triangles, side by side, in the tree's frame.
struct alignas(64) Boxes {
  float low[3][kClusterWidth], high[3][kClusterWidth];
  std::uint32_t hub[kClusterWidth];  // see Hubs
  std::uint32_t only_hub;            // of all of them; else kNone
};

// Vertices of many triangles. All triangles at a hub have boxes that overlap, so pairs at a hub are
// found by their directions from it.
class Hubs {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  Hubs(const TriangleMesh& mesh, const Progress* progress)
      : mesh_(mesh), progress_(progress), of_(mesh.triangles.size(), kNone) {
    constexpr std::uint32_t kMany = 64;
    std::vector<std::uint32_t> uses(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) ++uses[v];
    }
    for (std::uint32_t t = 0; t < of_.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) {
        if (uses[v] > kMany) of_[t] = v;
      }
    }
  }

  // Returns a hub that the triangle has, or kNone.
  [[nodiscard]] std::uint32_t of(std::uint32_t triangle) const { return of_[triangle]; }

  // Calls `body` for all pairs of triangles at one hub that may meet beyond it, until it returns
  // false.
  template <class Body>
  void for_each_pair(const Body& body) const {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < of_.size(); ++t) {
      if (of_[t] != kNone && !has_equal_indices(mesh_.triangles[t])) triangles.push_back(t);
    }
    std::stable_sort(triangles.begin(), triangles.end(),
                     [this](std::uint32_t a, std::uint32_t b) { return of_[a] < of_[b]; });
    for (std::size_t begin = 0, end = 0; begin < triangles.size(); begin = end) {
      while (end < triangles.size() && of_[triangles[end]] == of_[triangles[begin]]) ++end;
      if (!sweep(std::span(triangles).subspan(begin, end - begin), body)) return;
    }
  }

 private:
  struct Arc {
    Eigen::AlignedBox3d box;
    std::uint32_t triangle;
  };

  // Returns a box round all directions from the hub into a triangle.
  [[nodiscard]] Arc arc_of(std::uint32_t triangle) const {
    Arc arc{{}, triangle};
    Vector last = Vector::Zero();
    double chord = 0;
    for (const std::uint32_t v : mesh_.triangles[triangle]) {
      if (v == of_[triangle]) continue;
      const Vector way = difference(mesh_.vertices[v], mesh_.vertices[of_[triangle]]);
      const double length = length_in_order(way);
      if (!(length > 0x1p-400 && length < 0x1p400)) {  // its square underflows or overflows
        arc.box.extend(Vector(-1, -1, -1));
        arc.box.extend(Vector(1, 1, 1));
        continue;
      }
      const Vector direction = scaled(1 / length, way);
      chord = square_in_order(difference(direction, last));
      arc.box.extend(direction);
      last = direction;
    }
    // An arc leaves its chord by less than a quarter of the chord's square.
    const double pad = 0.25 * chord + 1e-12;
    arc.box.min().array() -= pad;
    arc.box.max().array() += pad;
    return arc;
  }

  template <class Body>
  bool sweep(std::span<const std::uint32_t> triangles, const Body& body) const {
    std::vector<Arc> arcs;
    Vector middle = Vector::Zero(), spread = Vector::Zero();
    for (const std::uint32_t t : triangles) {
      arcs.push_back(arc_of(t));
      middle += arcs.back().box.center();
    }
    middle /= static_cast<double>(arcs.size());
    for (const Arc& arc : arcs) spread += (arc.box.center() - middle).cwiseAbs();
    Eigen::Index axis = 0;  // along which few arcs overlap
    spread.maxCoeff(&axis);
    std::sort(arcs.begin(), arcs.end(), [axis](const Arc& a, const Arc& b) {
      return std::pair(a.box.min()[axis], a.triangle) < std::pair(b.box.min()[axis], b.triangle);
    });
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      if (i % 1024 == 0) look_for_an_end(progress_);
      for (std::size_t j = i + 1; j < arcs.size(); ++j) {
        if (arcs[j].box.min()[axis] > arcs[i].box.max()[axis]) break;
        if (!arcs[i].box.intersects(arcs[j].box)) continue;
        if (!body(arcs[i].triangle, arcs[j].triangle)) return false;
      }
    }
    return true;
  }

  const TriangleMesh& mesh_;
  const Progress* progress_;
  std::vector<std::uint32_t> of_;
};

// Returns whether two triangles at the edge (u, v) lie on one side of it if they lie in one plane.
bool folds_over(const Vector& u, const Vector& v, const Vector& a, const Vector& b) {
  Eigen::Index steepest = 0;
  cross_in_order(difference(v, u), difference(a, u)).cwiseAbs().maxCoeff(&steepest);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Index i = (steepest + k + 1) % 3, j = (steepest + k + 2) % 3;
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

// Returns whether a plane through an edge of `a`, about at a right angle to `a`, certainly
// separates the triangles. Exact predicates take much longer for needles beside each other in a
// plane.
bool an_edge_separates(const TriangleCorners& a, const TriangleCorners& b) {
  const Vector normal = cross_in_order(difference(a[1], a[0]), difference(a[2], a[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& from = a[i];
    const Vector out = cross_in_order(difference(a[(i + 1) % 3], from), normal);
    double size = 0;
    const auto height = [&](const Vector& p) {
      const Vector way = difference(p, from);
      size = std::max(size, way.cwiseAbs().maxCoeff());
      return dot_in_order(out, way);
    };
    const double own = std::max({0.0, height(a[(i + 1) % 3]), height(a[(i + 2) % 3])}),
                 other = std::min({height(b[0]), height(b[1]), height(b[2])});
    if (other - own > 0x1p-40 * out.cwiseAbs().maxCoeff() * size + 0x1p-900) return true;
  }
  return false;
}

// Returns whether a plane through the corner that two triangles share certainly separates the rest
// of them. Exact predicates take much longer for triangles of one plane.
bool a_plane_separates_fans(const TriangleCorners& a, const TriangleCorners& b) {
  const std::array<Vector, 4> ways = {difference(a[1], a[0]), difference(a[2], a[0]),
                                      difference(b[1], b[0]), difference(b[2], b[0])};
  const Vector into_a = sum(ways[0], ways[1]), into_b = sum(ways[2], ways[3]);
  const Vector across =
      difference(scaled(length_in_order(into_a), into_b), scaled(length_in_order(into_b), into_a));
  const double size = across.cwiseAbs().maxCoeff();
  const auto is_beyond = [&](const Vector& way, double side) {
    return side * dot_in_order(across, way) > 0x1p-48 * size * way.cwiseAbs().maxCoeff() + 0x1p-900;
  };
  return is_beyond(ways[0], -1) && is_beyond(ways[1], -1) && is_beyond(ways[2], 1) &&
         is_beyond(ways[3], 1);
}

bool meet_beyond_shared(const TriangleMesh& mesh, const Triangle& first, const Triangle& second) {
  const auto [a, b, shared] = neighbours_of(mesh, first, second);
  switch (shared) {
    case 0:
      return !an_edge_separates(a, b) && !an_edge_separates(b, a) && triangles_meet(a, b);
    case 1:
      return !a_plane_separates_fans(a, b) && fans_meet(a, b);
    case 2:
      return folds_over(a[0], a[1], a[2], b[2]) && orientation(a[0], a[1], a[2], b[2]) == 0;
    default:
      return true;  // one triangle twice
  }
}

class Search {
 public:
  Search(const TriangleMesh& mesh, const TriangleClusters& clusters, const Progress* progress)
      : mesh_(mesh),
        clusters_(clusters),
        hubs_(mesh, progress),
        boxes_(clusters.node_count(0)),
        has_area_(mesh.triangles.size()) {
    slack_ = rounded_up(0x1p-21 * clusters.extent());
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
    std::array<Node, TriangleClusters::kMostLevels * kClusterWidth> stack;
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

  // Lists the pairs at hubs.
  void list_hub_pairs(std::vector<Pair>& out) const {
    hubs_.for_each_pair([&](std::uint32_t first, std::uint32_t second) {
      compare_triangles(first, second, out);
      return out.size() <= SelfIntersections::kMost;
    });
  }

 private:
  void put_boxes(std::uint32_t cluster) {
    Boxes& boxes = boxes_[cluster];
    const TriangleCluster& of = clusters_.clusters()[cluster];
    for (std::size_t k = 0; k < kClusterWidth; ++k) {
      const Triangle& t = mesh_.triangles[of.id[k]];
      const TriangleCorners corners = {mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                       mesh_.vertices[t[2]]};
      if (k < clusters_.child_count(-1, cluster)) {
        has_area_[of.id[k]] = !has_equal_indices(t) && has_area(corners);
      }
      TriangleCorners at;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        for (std::size_t corner = 0; corner < 3; ++corner) {
          at[corner][axis] = dot_in_order(clusters_.axes().col(axis),
                                          difference(corners[corner], clusters_.origin()));
        }
        boxes.low[i][k] = static_cast<float>(std::min({at[0][axis], at[1][axis], at[2][axis]}));
        boxes.high[i][k] = static_cast<float>(std::max({at[0][axis], at[1][axis], at[2][axis]}));
      }
      boxes.hub[k] = hubs_.of(of.id[k]);
    }
    const bool is_one = std::all_of(boxes.hub, boxes.hub + kClusterWidth,
                                    [&](std::uint32_t hub) { return hub == boxes.hub[0]; });
    boxes.only_hub = is_one ? boxes.hub[0] : Hubs::kNone;
  }

  [[nodiscard]] std::uint32_t lanes_near(const NodeBlock& own, std::size_t at,
                                         const NodeBlock& block) const {
    alignas(64) float apart[kClusterWidth];
    for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
      float most = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(block.centre[i][lane] - own.centre[i][at]) -
                                  (block.half[i][lane] + own.half[i][at]));
      }
      apart[lane] = most;
    }
    return lanes_within(apart, slack_);
  }

  void compare(std::uint32_t one, std::uint32_t other, std::vector<Pair>& out) const {
    if (other < one) return;
    constexpr float kFar = std::numeric_limits<float>::infinity();
    const Boxes &a = boxes_[one], &b = boxes_[other];
    if (a.only_hub != Hubs::kNone && a.only_hub == b.only_hub) return;
    const std::uint32_t count = clusters_.child_count(-1, other);
    for (std::uint32_t k = 0; k < clusters_.child_count(-1, one); ++k) {
      const std::uint32_t first = clusters_.clusters()[one].id[k];
      const bool at_hub = a.hub[k] != Hubs::kNone;
      alignas(64) float apart[kClusterWidth];
      for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
        float most = -kFar;
        for (std::size_t i = 0; i < 3; ++i) {
          most = std::max(most,
                          std::max(b.low[i][lane] - a.high[i][k], a.low[i][k] - b.high[i][lane]));
        }
        apart[lane] = at_hub && b.hub[lane] == a.hub[k] ? kFar : most;
      }
      for (std::uint32_t lane = one == other ? k + 1 : 0; lane < count; ++lane) {
        if (apart[lane] > slack_) continue;
        compare_triangles(first, clusters_.clusters()[other].id[lane], out);
      }
    }
  }

  void compare_triangles(std::uint32_t first, std::uint32_t second, std::vector<Pair>& out) const {
    if (has_area_[first] == 0 || has_area_[second] == 0) return;
    if (meet_beyond_shared(mesh_, mesh_.triangles[first], mesh_.triangles[second])) {
      out.push_back({std::min(first, second), std::max(first, second)});
    }
  }

  const TriangleMesh& mesh_;
  const TriangleClusters& clusters_;
  Hubs hubs_;
  std::vector<Boxes> boxes_;
  std::vector<std::uint8_t> has_area_;  // of each triangle; threads write neighbours
  float slack_ = 0;                     // more than the rounding of bounds in the tree's frame
};

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          const TriangleClusters& clusters,
                                          const Progress* progress) {
  const Search search(mesh, clusters, progress);
  SelfIntersections found;
  const std::size_t count = clusters.node_count(0);
  for (std::size_t done = 0; done < count && found.complete; done += kAtOnce) {
    look_for_an_end(progress);
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
  search.list_hub_pairs(found.pairs);
  found.complete = found.complete && found.pairs.size() <= SelfIntersections::kMost;
  std::sort(found.pairs.begin(), found.pairs.end());
  if (found.pairs.size() > SelfIntersections::kMost) found.pairs.resize(SelfIntersections::kMost);
  return found;
}

}  // namespace ist
