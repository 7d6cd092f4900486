#include "ist/measure/depth_front.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Bounds the rounding of a place in the field, as a part of the coordinates.
constexpr double kPlaceRounding = 0x1p-18;
// Clusters whose triangles are looked at for a first deep point, and triangles that are measured.
constexpr std::size_t kProbedClusters = 32, kProbes = 4;
// Entries by which a front may grow before it is made anew.
constexpr std::size_t kMoreEntries = 4000;
// Triangles of neighbours that may bound a triangle.
constexpr std::size_t kNeighbours = 3;

const OuterBalls& balls_of(const SphereTree& body) {
  return *parts_of(body).triangles->outer_balls();
}

std::uint32_t lanes_of(std::uint32_t count) { return (std::uint32_t{1} << count) - 1; }

}  // namespace

DepthFront::DepthFront(const std::array<SurfaceInBody, 2>& sides, const ClusterKernels& kernels)
    : sides_{{{parts_of(sides[0].surface).triangles->clusters, balls_of(sides[0].body), sides[0],
               grid_of(balls_of(sides[0].body))},
              {parts_of(sides[1].surface).triangles->clusters, balls_of(sides[1].body), sides[1],
               grid_of(balls_of(sides[1].body))}}},
      kernels_(kernels) {}

bool DepthFront::set_pose(std::size_t index, const RigidMove& to_body, DepthSearch& search) {
  Side& side = sides_[index];
  const double unit = side.balls.unit;
  const Vector at = difference(to_body(side.clusters.origin()), side.balls.middle);
  bool is_finite = true;
  double size = std::sqrt(3.0) * side.clusters.extent();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const Vector turned = to_body.turned(side.clusters.axes().col(axis));
    for (std::size_t k = 0; k < 3; ++k) {
      side.pose.rotation[k][i] = static_cast<float>(turned[static_cast<Eigen::Index>(k)]);
    }
    side.pose.translation[i] = static_cast<float>(at[axis] / unit);
    is_finite = is_finite && std::abs(side.pose.translation[i]) < 1e18F;
    size += std::abs(at[axis]);
  }
  side.pose.scale = static_cast<float>(1 / unit);
  side.pose.pad = rounded_up((kPlaceRounding * size + search.rounding()) / unit);
  is_finite = is_finite && size / unit < 1e18;
  search.set_balls(index,
                   {side.grid, side.balls.middle, unit, side.pose.pad, kernels_.bound_around});
  return is_finite;
}

// The limit in the units of a side's field, rounded down.
float DepthFront::limit_of(const Side& side, const DepthSearch& search) const noexcept {
  return static_cast<float>(search.limit() / side.balls.unit * (1 - 0x1p-22));
}

double DepthFront::bound_in(const Side& side, float bound) const noexcept {
  return bound < std::numeric_limits<float>::infinity() ? double{bound} * side.balls.unit
                                                        : HUGE_VAL;
}

bool DepthFront::search_all(DepthSearch& search, bool keeps) {
  keeps_ = keeps;
  keys_.clear();
  entries_.clear();
  clusters_.clear();
  for (std::uint8_t side = 0; side < 2; ++side) {
    sides_[side].clock = 0;
    const auto level = static_cast<std::uint8_t>(sides_[side].clusters.root_level());
    open_node({HUGE_VAL, 0, 0, level, side, 0, kNowhere}, search);
  }
  if (!search.deepest()) probe(search);
  const bool is_complete = finish(search);
  most_entries_ = keys_.size() + kMoreEntries;
  return is_complete;
}

bool DepthFront::search_front(DepthSearch& search, const std::array<double, 2>& ways) {
  for (std::size_t side = 0; side < 2; ++side) sides_[side].clock += ways[side];
  again_.clear();
  clusters_.clear();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const Entry& entry = entries_[k];
    const double bound = keys_[k] + sides_[entry.side].clock;
    if (search.is_settled(bound)) continue;
    again_.push_back({bound, entry.index, 0, entry.level, entry.side, entry.taken, k});
  }
  // Triangles come first: they give deep points.
  std::sort(again_.begin(), again_.end(), [](const Open& a, const Open& b) {
    const bool a_first = a.level == kTriangle, b_first = b.level == kTriangle;
    return a_first != b_first ? a_first : a < b;
  });
  for (const Open& one : again_) {
    if (search.is_settled(one.bound)) continue;
    if (!search.goes_on()) break;
    if (one.level == kTriangle) {
      const FewTriangles near = entries_[one.entry].near;
      given_.push_back(
          {one.entry, search.add_triangle(one.side, one.index, one.bound, near, near.count > 0)});
    } else if (one.level == 0) {
      open_cluster(one, search);
    } else {
      open_node(one, search);
    }
  }
  return finish(search);
}

// Opens the clusters that are left, hands over their triangles, and settles them.
bool DepthFront::finish(DepthSearch& search) {
  for (const Open& cluster : clusters_) {
    if (search.is_settled(cluster.bound)) {
      keep(cluster, cluster.bound, 0);
      search.leave(cluster.bound);
    } else {
      open_cluster(cluster, search);
    }
  }
  hand_over(search);
  const bool is_complete = search.run();
  for (const Given& given : given_) {
    const DepthSearch::Handed& handed = search.handed()[given.handed];
    Entry& entry = entries_[given.entry];
    keys_[given.entry] = handed.bound - sides_[entry.side].clock;
    entry.near = handed.near;
  }
  given_.clear();
  return is_complete;
}

double DepthFront::bound(const DepthSearch& search) const noexcept {
  double most = search.bound();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    most = std::max(most, keys_[k] + sides_[entries_[k].side].clock);
  }
  return most;
}

// Gives what is now known to an entry, or to a new one.
void DepthFront::keep(const Open& one, double bound, std::uint32_t taken) {
  if (!keeps_) return;
  const double key = bound - sides_[one.side].clock;
  const auto bits = static_cast<std::uint16_t>(taken);
  if (one.entry != kNowhere) {
    keys_[one.entry] = key;
    entries_[one.entry].taken = bits;
    return;
  }
  keys_.push_back(key);
  entries_.push_back({one.index, one.level, one.side, bits, {}});
}

// Bounds the children of a node but those that are taken, and opens those that may be too deep.
// Clusters among them are put down for later.
void DepthFront::open_node(const Open& node, DepthSearch& search) {
  const Side& side = sides_[node.side];
  nodes_.assign(1, node);
  while (!nodes_.empty()) {
    const Open one = nodes_.back();
    nodes_.pop_back();
    const int below = one.level - 1;
    const std::uint32_t lanes =
        lanes_of(side.clusters.child_count(below, one.index)) & ~std::uint32_t{one.taken};
    alignas(64) float bounds[kClusterWidth];
    const BallLanes found = kernels_.bound_nodes(side.clusters.bounds(below)[one.index], side.grid,
                                                 side.pose, limit_of(side, search), lanes, bounds);
    ++tests_;
    const double most = bound_in(side, found.most);
    search.leave(most);
    keep(one, most, one.taken | found.over);
    for (std::uint32_t over = found.over; over != 0; over &= over - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(over));
      const Open child{bound_in(side, bounds[lane]),
                       kClusterWidth * one.index + lane,
                       0,
                       static_cast<std::uint8_t>(below),
                       one.side,
                       0,
                       kNowhere};
      (below > 0 ? nodes_ : clusters_).push_back(child);
    }
  }
}

BallLanes DepthFront::bound_triangles(const Open& cluster, const DepthSearch& search,
                                      float (&bounds)[kClusterWidth]) {
  const Side& side = sides_[cluster.side];
  const std::uint32_t lanes =
      lanes_of(side.clusters.child_count(-1, cluster.index)) & ~std::uint32_t{cluster.taken};
  ++tests_;
  return kernels_.bound_corners(side.clusters.clusters()[cluster.index],
                                side.clusters.bounds(0)[cluster.index / kClusterWidth],
                                cluster.index % kClusterWidth, side.grid, side.pose,
                                limit_of(side, search), lanes, bounds);
}

// Bounds the triangles of a cluster but those that are taken. Those that may be too deep are put
// down for later.
void DepthFront::open_cluster(const Open& cluster, DepthSearch& search) {
  const Side& side = sides_[cluster.side];
  alignas(64) float bounds[kClusterWidth];
  const BallLanes found = bound_triangles(cluster, search, bounds);
  const double most = bound_in(side, found.most);
  search.leave(most);
  keep(cluster, most, cluster.taken | found.over);
  for (std::uint32_t over = found.over; over != 0; over &= over - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(over));
    triangles_.push_back({bound_in(side, bounds[lane]),
                          side.clusters.clusters()[cluster.index].id[lane], cluster.index,
                          kTriangle, cluster.side, 0, kNowhere});
  }
}

// Measures points of triangles that are deep by their balls, so that the search soon has a deep
// point.
void DepthFront::probe(DepthSearch& search) {
  triangles_.clear();
  const std::size_t count = std::min(kProbedClusters, clusters_.size());
  std::partial_sort(clusters_.begin(), clusters_.begin() + static_cast<std::ptrdiff_t>(count),
                    clusters_.end());
  for (std::size_t k = 0; k < count; ++k) {
    const Open& cluster = clusters_[k];
    alignas(64) float bounds[kClusterWidth];
    const BallLanes found = bound_triangles(cluster, search, bounds);
    if (found.over == 0) continue;
    auto best = static_cast<std::uint32_t>(std::countr_zero(found.over));
    for (std::uint32_t over = found.over; over != 0; over &= over - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(over));
      if (bounds[lane] > bounds[best]) best = lane;
    }
    const std::uint32_t triangle = sides_[cluster.side].clusters.clusters()[cluster.index].id[best];
    triangles_.push_back({search.bound_by_balls(cluster.side, triangle), triangle, cluster.index,
                          kTriangle, cluster.side, 0, kNowhere});
  }
  std::sort(triangles_.begin(), triangles_.end());
  for (std::size_t k = 0; k < std::min(kProbes, triangles_.size()); ++k) {
    const Open& one = triangles_[k];
    if (search.is_settled(one.bound) || !search.goes_on()) break;
    search.probe(one.side, one.index);
  }
  triangles_.clear();
}

// Hands over the triangles that are left, the deepest first, with what was nearest to their
// neighbours.
void DepthFront::hand_over(DepthSearch& search) {
  std::sort(triangles_.begin(), triangles_.end());
  settled_.clear();
  for (const Open& one : triangles_) {
    keep(one, one.bound, 0);
    if (search.is_settled(one.bound) || !search.goes_on()) {
      search.leave(one.bound);
      continue;
    }
    FewTriangles near;
    for (const Settled& other : settled_) {
      if (near.count == kNeighbours) break;
      if (other.cluster == one.cluster && other.side == one.side) near.add(other.near);
    }
    const std::size_t handed = search.add_triangle(one.side, one.index, one.bound, near, false);
    const FewTriangles& found = search.handed()[handed].near;
    if (found.count > near.count) {
      settled_.push_back({one.cluster, found.triangle[near.count], one.side});
    }
    if (keeps_) given_.push_back({entries_.size() - 1, handed});
  }
  triangles_.clear();
}

}  // namespace ist
