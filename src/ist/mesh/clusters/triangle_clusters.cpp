#include "ist/mesh/clusters/triangle_clusters.h"

#include <array>
#include <limits>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/base/symmetric_eigen.h"

namespace ist {
namespace {

constexpr std::size_t kWidth = 16;
// Parts of so many triangles are ordered side by side.
constexpr std::size_t kPart = kWidth * kWidth * kWidth;

struct Item {
  std::array<float, 3> centre;
  std::uint32_t triangle;
};

Item item_of(std::uint32_t triangle, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  return {{static_cast<float>((a[0] + b[0]) + c[0]), static_cast<float>((a[1] + b[1]) + c[1]),
           static_cast<float>((a[2] + b[2]) + c[2])},
          triangle};
}

std::size_t longest_axis(std::span<const Item> items) {
  std::array<float, 3> low = items[0].centre, high = low;
  for (const Item& item : items) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], item.centre[i]);
      high[i] = std::max(high[i], item.centre[i]);
    }
  }
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[longest] - low[longest]) longest = i;
  }
  return longest;
}

// Whether an item comes before another one. Positions of equal centres are those of their indices,
// so that the parts do not depend on the selection.
struct Before {
  std::size_t axis;
  bool operator()(const Item& a, const Item& b) const {
    const float x = a.centre[axis], y = b.centre[axis];
    const auto less = static_cast<unsigned>(x < y), equal = static_cast<unsigned>(x == y);
    return (less | (equal & static_cast<unsigned>(a.triangle < b.triangle))) != 0;
  }
};

// Does what std::nth_element does, without branches that depend on the items.
void select(std::span<Item> items, std::size_t nth, const Before& before) {
  constexpr std::size_t kFew = 48;
  for (int round = 0; items.size() > kFew && round < 64; ++round) {
    const std::size_t last = items.size() - 1, step = items.size() / 8;
    const auto middle_of_three = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (before(items[b], items[a])) std::swap(a, b);
      if (before(items[c], items[b])) b = before(items[c], items[a]) ? a : c;
      return b;
    };
    const std::size_t chosen = middle_of_three(middle_of_three(0, step, 2 * step),
                                               middle_of_three(3 * step, 4 * step, 5 * step),
                                               middle_of_three(6 * step, 7 * step, last));
    std::swap(items[chosen], items[last]);
    const Item pivot = items[last];
    std::size_t less = 0;
    for (std::size_t i = 0; i < last; ++i) {
      const Item item = items[i];
      items[i] = items[less];
      items[less] = item;
      less += static_cast<std::size_t>(before(item, pivot));
    }
    std::swap(items[less], items[last]);
    if (less == nth) return;
    if (nth < less) {
      items = items.first(less);
    } else {
      items = items.subspan(less + 1);
      nth -= less + 1;
    }
  }
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(nth), items.end(),
                   before);
}

// Orders the items until parts of kWidth are left. Both sides of a large part are ordered side by
// side.
void halve(std::span<Item> items, const Progress* progress) {
  while (items.size() > kWidth) {
    std::size_t part = kWidth;
    while (part * kWidth < items.size()) part *= kWidth;
    const std::size_t parts = (items.size() + part - 1) / part;
    const std::size_t middle = part * (parts / 2);
    select(items, middle, {longest_axis(items)});
    const std::span<Item> sides[2] = {items.first(middle), items.subspan(middle)};
    if (items.size() > kPart) {
      if (progress != nullptr) progress->check();
      parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t side = begin; side < end; ++side) halve(sides[side], progress);
      });
      return;
    }
    halve(sides[0], progress);
    items = sides[1];
  }
}

// Orders the triangles by their items.
std::vector<std::uint32_t> order_of(std::span<Item> items, const Progress* progress) {
  halve(items, progress);
  std::vector<std::uint32_t> order(items.size());
  parallel_for(items.size(), kPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) order[k] = items[k].triangle;
    for (std::size_t first = begin; first < end; first += kWidth) {
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                order.begin() + static_cast<std::ptrdiff_t>(std::min(first + kWidth, end)));
    }
  });
  return order;
}

using Vector = Eigen::Vector3d;
using Points = std::span<const Vector>;
using Ids = std::span<const std::uint32_t>;
// Centres have 22 digits, so that a difference of two has 23.
constexpr double kGridCells = 0x1p22;
// Clusters that one task makes, with the nodes above them.
constexpr std::size_t kGrain = 64;
constexpr std::size_t kVerticesATask = 1 << 14;
// By how much the square of a normal's length may differ from 1, doubled.
constexpr double kNormalRounding = 0x1p-21;

float nearest_above(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest >= value ? nearest
                          : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

double grid_of(double extent) {
  int exponent = 0;
  std::frexp(extent, &exponent);  // extent <= 2^exponent
  return std::ldexp(1 / kGridCells, exponent);
}

// The sum of some points, and of their products.
struct Moments {
  double count = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Vector& p) {
    count += 1;
    x += p[0];
    y += p[1];
    z += p[2];
    xx += p[0] * p[0];
    xy += p[0] * p[1];
    xz += p[0] * p[2];
    yy += p[1] * p[1];
    yz += p[1] * p[2];
    zz += p[2] * p[2];
  }
  void add(const Moments& other) {
    count += other.count;
    x += other.x;
    y += other.y;
    z += other.z;
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
  }
  // The axes of the points' spread, from the least to the widest: the columns.
  [[nodiscard]] Eigen::Matrix3d axes() const {
    const double a = x / count, b = y / count, c = z / count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    spread(0, 0) = xx / count - a * a;
    spread(0, 1) = xy / count - a * b;
    spread(0, 2) = xz / count - a * c;
    spread(1, 1) = yy / count - b * b;
    spread(1, 2) = yz / count - b * c;
    spread(2, 2) = zz / count - c * c;
    return symmetric_eigen(spread).vectors;
  }
};

// The least and the greatest of some numbers.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

// Puts the bounds of all points of some lists into a lane of a block. Returns their centre.
Vector put_bounds(std::span<const Points> lists, const Vector& normal, double grid,
                  NodeBlock& block, std::size_t lane) {
  constexpr double kRounding = 1 + 0x1p-40;
  Range range[3];
  for (const Points& points : lists) {
    for (const Vector& p : points) {
      for (std::size_t i = 0; i < 3; ++i) range[i].add(p[static_cast<Eigen::Index>(i)]);
    }
  }
  Vector centre, n;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const auto [low, high] = range[i];
    centre[axis] = grid * std::round(0.5 * (low + high) / grid);
    n[axis] = static_cast<float>(normal[axis]);
    block.centre[i][lane] = static_cast<float>(centre[axis]);
    block.half[i][lane] =
        nearest_above(kRounding * std::max(high - centre[axis], centre[axis] - low));
    block.normal[i][lane] = static_cast<float>(n[axis]);
  }
  Range heights;
  double radius = 0, rim = 0;
  for (const Points& points : lists) {
    for (const Vector& p : points) {
      const Vector v = difference(p, centre);
      const double height = dot_in_order(n, v), squared = dot_in_order(v, v);
      heights.add(height);
      radius = std::max(radius, squared);
      rim = std::max(rim, squared - height * height);
    }
  }
  const auto offset = static_cast<float>(0.5 * (heights.low + heights.high));
  block.offset[lane] = offset;
  block.thickness[lane] = nearest_above(
      kRounding * std::max(heights.high - double{offset}, double{offset} - heights.low));
  block.radius[lane] = nearest_above(kRounding * std::sqrt(radius));
  // The square errs by a few roundings of the radius', and the normal is not quite a unit.
  block.rim[lane] = nearest_above(std::sqrt(rim + kNormalRounding * radius));
  return centre;
}

// The corners of up to 16 triangles: each vertex once, in the order of its first use.
struct ClusterCorners {
  static constexpr std::size_t kMost = 3 * kClusterWidth;
  std::uint32_t vertex[kMost];  // of the mesh
  std::uint8_t of[kMost];       // the vertex of each corner, as an index of the array above
  std::size_t vertices = 0, corners = 0;

  ClusterCorners(const TriangleMesh& mesh, Ids ids) {
    for (const std::uint32_t id : ids) {
      for (const std::uint32_t v : mesh.triangles[id]) {
        std::size_t at = 0;
        while (at < vertices && vertex[at] != v) ++at;
        if (at == vertices) vertex[vertices++] = v;
        of[corners++] = static_cast<std::uint8_t>(at);
      }
    }
  }
};

// Makes a cluster of triangles whose vertices are `points`.
TriangleCluster cluster_of(const ClusterCorners& corners, Points points, Ids ids,
                           const Vector& centre, const Eigen::Matrix3d& axes) {
  TriangleCluster cluster;
  Vector ways[ClusterCorners::kMost];
  for (std::size_t k = 0; k < points.size(); ++k) ways[k] = difference(points[k], centre);
  for (std::size_t i = 0; i < 3; ++i) {
    Vector axis;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component =
          static_cast<float>(axes(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)));
      cluster.axis[k][i] = component;
      axis[static_cast<Eigen::Index>(k)] = component;
    }
    cluster.low[i] = std::numeric_limits<float>::infinity();
    cluster.high[i] = -cluster.low[i];
    float coordinate[ClusterCorners::kMost];
    for (std::size_t k = 0; k < points.size(); ++k) {
      coordinate[k] = static_cast<float>(dot_in_order(axis, ways[k]));
      cluster.low[i] = std::min(cluster.low[i], coordinate[k]);
      cluster.high[i] = std::max(cluster.high[i], coordinate[k]);
    }
    for (std::size_t k = 0; k < kClusterWidth; ++k) {
      const std::size_t of = 3 * std::min(k, ids.size() - 1);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        cluster.corner[corner][i][k] = coordinate[corners.of[of + corner]];
      }
    }
  }
  for (std::size_t k = 0; k < kClusterWidth; ++k) cluster.id[k] = ids[std::min(k, ids.size() - 1)];
  cluster.zero = 0;
  return cluster;
}

// The vertices of kGrain clusters, one list after the other, each vertex of a cluster once.
struct VertexLists {
  std::vector<Vector> points;
  std::array<std::size_t, kGrain + 1> first{};  // of each cluster

  // Returns the points of the clusters [begin, end) of these.
  [[nodiscard]] Points of(std::size_t begin, std::size_t end) const {
    return Points(points).subspan(first[begin], first[end] - first[begin]);
  }
};

}  // namespace

std::vector<std::uint32_t> triangle_order(std::span<const Eigen::Vector3d> corners) {
  std::vector<Item> items(corners.size() / 3);
  for (std::uint32_t k = 0; k < items.size(); ++k) {
    items[k] = item_of(k, corners[std::size_t{3} * k], corners[std::size_t{3} * k + 1],
                       corners[std::size_t{3} * k + 2]);
  }
  return order_of(items, nullptr);
}

TriangleClusters::TriangleClusters(const TriangleMesh& mesh, const Vector& origin,
                                   const Progress* progress)
    : origin_(origin),
      triangle_count_(static_cast<std::uint32_t>(mesh.triangles.size())),
      counts_(node_counts(triangle_count_)) {
  Moments whole;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) whole.add(difference(mesh.vertices[v], origin));
  }
  axes_ = whole.axes();
  std::vector<Vector> moved(mesh.vertices.size());  // along the axes
  parallel_for(moved.size(), kVerticesATask, [&](std::size_t begin, std::size_t end) {
    const Vector x = axes_.col(0), y = axes_.col(1), z = axes_.col(2);
    for (std::size_t v = begin; v < end; ++v) {
      const Vector p = difference(mesh.vertices[v], origin);
      moved[v] = {dot_in_order(x, p), dot_in_order(y, p), dot_in_order(z, p)};
    }
  });
  std::vector<Item> items(triangle_count_);
  std::vector<double> extents((items.size() + kVerticesATask - 1) / kVerticesATask);
  parallel_for(items.size(), kVerticesATask, [&](std::size_t begin, std::size_t end) {
    double extent = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const auto [a, b, c] = mesh.triangles[k];
      for (const std::uint32_t v : {a, b, c}) {
        for (const double x : moved[v]) extent = std::max(extent, std::abs(x));
      }
      items[k] = item_of(static_cast<std::uint32_t>(k), moved[a], moved[b], moved[c]);
    }
    extents[begin / kVerticesATask] = extent;
  });
  double extent = 0;
  for (const double one : extents) extent = std::max(extent, one);
  grid_ = grid_of(extent);
  const std::vector<std::uint32_t> order = order_of(items, progress);
  items = {};

  clusters_.resize(counts_[0]);
  for (const std::uint32_t count : counts_) levels_.emplace_back(block_count(count));
  std::vector<Moments> below(counts_[0]);
  std::vector<VertexLists> lists((counts_[0] + kGrain - 1) / kGrain);
  parallel_for(counts_[0], kGrain, [&](std::size_t begin, std::size_t end) {
    if (progress != nullptr) progress->check();
    VertexLists& list = lists[begin / kGrain];
    list.points.reserve((end - begin) * ClusterCorners::kMost / 2);
    for (std::size_t node = begin; node < end; ++node) {
      const std::size_t first = node * kClusterWidth;
      const Ids ids =
          Ids(order).subspan(first, std::min(first + kClusterWidth, order.size()) - first);
      const ClusterCorners corners(mesh, ids);
      for (std::size_t k = 0; k < corners.vertices; ++k) {
        list.points.push_back(moved[corners.vertex[k]]);
      }
      list.first[node - begin + 1] = list.points.size();
      const Points points = list.of(node - begin, node - begin + 1);
      for (std::size_t k = 0; k < corners.corners; ++k) below[node].add(points[corners.of[k]]);
      const Eigen::Matrix3d axes = below[node].axes();
      const Vector centre = put_bounds({&points, 1}, axes.col(0), grid_,
                                       levels_[0][node / kClusterWidth], node % kClusterWidth);
      clusters_[node] = cluster_of(corners, points, ids, centre, axes);
    }
  });
  std::size_t width = kClusterWidth;  // clusters of a node
  for (std::size_t level = 1; level < counts_.size(); ++level, width *= kClusterWidth) {
    std::vector<Moments> moments(counts_[level]);
    const std::size_t grain = level == 1 ? kGrain / kClusterWidth : 1;
    parallel_for(moments.size(), grain, [&](std::size_t begin, std::size_t end) {
      std::vector<Points> mine;
      for (std::size_t node = begin; node < end; ++node) {
        const std::size_t child = kClusterWidth * node;
        for (std::size_t k = child; k < std::min(child + kClusterWidth, below.size()); ++k) {
          moments[node].add(below[k]);
        }
        mine.clear();
        const std::size_t last = std::min<std::size_t>((node + 1) * width, counts_[0]);
        for (std::size_t at = node * width; at < last;) {
          const std::size_t list = at / kGrain, to = std::min(last, (list + 1) * kGrain);
          mine.push_back(lists[list].of(at % kGrain, to - list * kGrain));
          at = to;
        }
        put_bounds(mine, moments[node].axes().col(0), grid_, levels_[level][node / kClusterWidth],
                   node % kClusterWidth);
      }
    });
    below = std::move(moments);
  }
}

TriangleClusters::TriangleClusters(std::uint32_t triangles, const Vector& origin,
                                   const Eigen::Matrix3d& axes, double grid,
                                   std::vector<std::vector<NodeBlock>> levels,
                                   std::vector<TriangleCluster> clusters)
    : origin_(origin),
      axes_(axes),
      grid_(grid),
      triangle_count_(triangles),
      counts_(node_counts(triangles)),
      levels_(std::move(levels)),
      clusters_(std::move(clusters)) {
  IST_ASSERT(levels_.size() == counts_.size() && clusters_.size() == counts_[0]);
}

std::vector<std::uint32_t> TriangleClusters::node_counts(std::uint32_t triangles) {
  std::vector<std::uint32_t> counts = {block_count(triangles)};
  while (counts.back() > 1 || counts.size() < 2) counts.push_back(block_count(counts.back()));
  return counts;
}

std::size_t TriangleClusters::bytes() const noexcept {
  std::size_t bytes = clusters_.size() * sizeof(TriangleCluster);
  for (const auto& blocks : levels_) bytes += blocks.size() * sizeof(NodeBlock);
  return bytes;
}

}  // namespace ist
