#include "ist/mesh/clusters/triangle_clusters.h"

#include <array>
#include <limits>

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

// Orders the items until parts of `smallest` are left. Positions of equal centres are those of
// their indices, so that the parts do not depend on the library's selection.
void halve(std::span<Item> items, std::size_t smallest) {
  while (items.size() > smallest) {
    std::size_t part = smallest;
    while (part * kWidth < items.size()) part *= kWidth;
    const std::size_t parts = (items.size() + part - 1) / part;
    const std::size_t middle = part * (parts / 2);
    const std::size_t axis = longest_axis(items);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle),
                     items.end(), [axis](const Item& a, const Item& b) {
                       if (a.centre[axis] != b.centre[axis]) {
                         return a.centre[axis] < b.centre[axis];
                       }
                       return a.triangle < b.triangle;
                     });
    halve(items.first(middle), smallest);
    items = items.subspan(middle);
  }
}

using Vector = Eigen::Vector3d;
using Points = std::span<const Vector>;
// Centres have 22 digits, so that a difference of two has 23.
constexpr double kGridCells = 0x1p22;
// Nodes whose boxes are made by one task.
constexpr std::size_t kGrain = 64;
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
  double count = 0;
  Vector sum = Vector::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Vector& p) {
    count += 1;
    for (Eigen::Index i = 0; i < 3; ++i) {
      sum[i] += p[i];
      for (Eigen::Index j = i; j < 3; ++j) products(i, j) += p[i] * p[j];
    }
  }
  void add(const Moments& other) {
    count += other.count;
    for (Eigen::Index i = 0; i < 3; ++i) {
      sum[i] += other.sum[i];
      for (Eigen::Index j = i; j < 3; ++j) products(i, j) += other.products(i, j);
    }
  }
  // The axes of the points' spread, from the least to the widest: the columns.
  [[nodiscard]] Eigen::Matrix3d axes() const {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = i; j < 3; ++j) {
        spread(i, j) = products(i, j) / count - (sum[i] / count) * (sum[j] / count);
      }
    }
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

// Puts the bounds of `points` into a lane of a block. Returns their centre.
Vector put_bounds(Points points, const Vector& normal, double grid, NodeBlock& block,
                  std::size_t lane) {
  constexpr double kRounding = 1 + 0x1p-40;
  Vector centre, n;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Range range;
    for (const Vector& p : points) range.add(p[i]);
    centre[i] = grid * std::round(0.5 * (range.low + range.high) / grid);
    n[i] = static_cast<float>(normal[i]);
    const auto axis = static_cast<std::size_t>(i);
    block.centre[axis][lane] = static_cast<float>(centre[i]);
    block.half[axis][lane] =
        nearest_above(kRounding * std::max(range.high - centre[i], centre[i] - range.low));
    block.normal[axis][lane] = static_cast<float>(n[i]);
  }
  Range heights;
  double radius = 0, rim = 0;
  for (const Vector& p : points) {
    const Vector v = difference(p, centre);
    const double height = dot_in_order(n, v), squared = dot_in_order(v, v);
    heights.add(height);
    radius = std::max(radius, squared);
    rim = std::max(rim, squared - height * height);
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

// Makes a cluster of the points of up to 16 triangles.
TriangleCluster cluster_of(Points points, std::span<const std::uint32_t> ids, const Vector& centre,
                           const Eigen::Matrix3d& axes) {
  TriangleCluster cluster;
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
    for (std::size_t k = 0; k < kClusterWidth; ++k) {
      const std::size_t of = std::min(k, ids.size() - 1);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto x =
            static_cast<float>(dot_in_order(axis, difference(points[3 * of + corner], centre)));
        cluster.corner[corner][i][k] = x;
        cluster.low[i] = std::min(cluster.low[i], x);
        cluster.high[i] = std::max(cluster.high[i], x);
      }
    }
  }
  for (std::size_t k = 0; k < kClusterWidth; ++k) cluster.id[k] = ids[std::min(k, ids.size() - 1)];
  return cluster;
}

std::uint32_t up(std::uint32_t count) { return (count + kClusterWidth - 1) / kClusterWidth; }

}  // namespace

std::vector<std::uint32_t> triangle_order(std::span<const Eigen::Vector3d> corners) {
  std::vector<Item> items(corners.size() / 3);
  for (std::uint32_t k = 0; k < items.size(); ++k) {
    const Eigen::Vector3d* const p = &corners[std::size_t{3} * k];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      items[k].centre[i] = static_cast<float>((p[0][axis] + p[1][axis]) + p[2][axis]);
    }
    items[k].triangle = k;
  }
  halve(items, kPart);
  parallel_for((items.size() + kPart - 1) / kPart, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      const std::size_t first = part * kPart;
      halve(std::span(items).subspan(first, std::min(kPart, items.size() - first)), kWidth);
    }
  });
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) order[k] = items[k].triangle;
  for (std::size_t first = 0; first < order.size(); first += kWidth) {
    const std::size_t last = std::min(first + kWidth, order.size());
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first),
              order.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return order;
}

TriangleClusters::TriangleClusters(const TriangleMesh& mesh, const Vector& origin)
    : origin_(origin), triangle_count_(static_cast<std::uint32_t>(mesh.triangles.size())) {
  counts_.push_back(up(triangle_count_));
  while (counts_.back() > 1 || counts_.size() < 2) counts_.push_back(up(counts_.back()));

  std::vector<Vector> points;
  points.reserve(3 * mesh.triangles.size());
  Moments whole;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      points.push_back(difference(mesh.vertices[vertex], origin));
      whole.add(points.back());
    }
  }
  axes_ = whole.axes();
  double extent = 0;
  for (Vector& p : points) {
    p = {dot_in_order(axes_.col(0), p), dot_in_order(axes_.col(1), p),
         dot_in_order(axes_.col(2), p)};
    extent = std::max(extent, p.cwiseAbs().maxCoeff());
  }
  grid_ = grid_of(extent);
  const std::vector<std::uint32_t> order = triangle_order(points);
  {
    std::vector<Vector> ordered(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        ordered[3 * k + corner] = points[std::size_t{3} * order[k] + corner];
      }
    }
    points = std::move(ordered);
  }
  clusters_.resize(counts_[0]);
  std::vector<Moments> below;
  std::size_t width = kClusterWidth;  // triangles of a node
  for (std::size_t level = 0; level < counts_.size(); ++level, width *= kClusterWidth) {
    std::vector<NodeBlock>& blocks = levels_.emplace_back(up(counts_[level]));
    std::vector<Moments> moments(counts_[level]);
    parallel_for(moments.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        const std::size_t first = node * width, last = std::min(first + width, order.size());
        const Points mine = Points(points).subspan(3 * first, 3 * (last - first));
        if (level == 0) {
          for (const Vector& p : mine) moments[node].add(p);
        } else {
          const std::size_t child = kClusterWidth * node;
          for (std::size_t k = child; k < std::min(child + kClusterWidth, below.size()); ++k) {
            moments[node].add(below[k]);
          }
        }
        const Eigen::Matrix3d axes = moments[node].axes();
        const Vector centre = put_bounds(mine, axes.col(0), grid_, blocks[node / kClusterWidth],
                                         node % kClusterWidth);
        if (level > 0) continue;
        clusters_[node] =
            cluster_of(mine, std::span(order).subspan(first, last - first), centre, axes);
      }
    });
    below = std::move(moments);
  }
}

std::size_t TriangleClusters::bytes() const noexcept {
  std::size_t bytes = clusters_.size() * sizeof(TriangleCluster);
  for (const auto& blocks : levels_) bytes += blocks.size() * sizeof(NodeBlock);
  return bytes;
}

}  // namespace ist
