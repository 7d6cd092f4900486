#include "ist/tree/nested_bounds.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/tree/enclosing_ball.h"
#include "ist/tree/leaf_search.h"
#include "ist/tree/least_axis.h"
#include "ist/tree/node_bounds.h"

namespace ist {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kGrain = 128;
// The part of itself by which a radius may exceed the smallest.
constexpr double kLooseness = 0.005;
constexpr int kMaxRounds = 64;
// The tilt that is tried for a thinner slab.
constexpr double kTilt = 0x1p-4;

double length_of(const Vector3d& v) noexcept { return std::sqrt(dot_in_order(v, v)); }

// The spread of the circles in which the leaves' slabs halve their balls: sums over the circles of
// their points' first and second moments. A circle has radius²/2 along each axis in its plane.
struct Spread {
  double count = 0;
  Vector3d sum = Vector3d::Zero();
  Symmetric products = {};

  void add(const Ball& ball, const Slab& slab) noexcept {
    const Vector3d& n = slab.normal;
    const double square = dot_in_order(n, n);
    const Vector3d p = ist::sum(ball.centre, scaled(square > 0 ? slab.offset / square : 0, n));
    const double moment = 0.5 * ball.radius * ball.radius;
    const double along = square > 0 ? moment / square : 0;
    const double x = p[0], y = p[1], z = p[2];
    count += 1;
    add_to(sum, p);
    products.xx += x * x + (moment - along * (n[0] * n[0]));
    products.xy += x * y - along * (n[0] * n[1]);
    products.xz += x * z - along * (n[0] * n[2]);
    products.yy += y * y + (moment - along * (n[1] * n[1]));
    products.yz += y * z - along * (n[1] * n[2]);
    products.zz += z * z + (moment - along * (n[2] * n[2]));
  }
  void add(const Spread& other) noexcept {
    count += other.count;
    add_to(sum, other.sum);
    products.xx += other.products.xx;
    products.xy += other.products.xy;
    products.xz += other.products.xz;
    products.yy += other.products.yy;
    products.yz += other.products.yz;
    products.zz += other.products.zz;
  }
  [[nodiscard]] Vector3d least_axis() const noexcept {
    return ist::least_axis(moments_about_mean(count, sum, products));
  }
};

static_assert(sizeof(Spread) == kNestingBytes);

// Rounds an axis to the longest packed normal near it: the longer, the better it separates.
PackedSlab longest_normal(const Vector3d& axis) noexcept {
  for (double length = 128;; length -= 0.25) {
    const auto rounded = [&](Eigen::Index i) {
      return static_cast<int>(length * axis[i] + 192.5) - 192;
    };
    const int x = rounded(0), y = rounded(1), z = rounded(2);
    if (x * x + y * y + z * z > 128 * 128) continue;
    if (std::max({x, y, z}) > 127 || std::min({x, y, z}) < -127) continue;
    return {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), static_cast<std::int8_t>(z),
            0, 0};
  }
}

Vector3d smallest_centre(const LeafSearch& leaves) noexcept {
  const Ball first = leaves.farthest(leaves.child_ball(0).centre).bound;
  Support<Ball> support{{first}, 1, first.centre, first.radius};
  Vector3d centre = first.centre;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMaxRounds; ++round) {
    const Greatest<Ball> outside = leaves.farthest(support.centre);
    if (outside.value < least) {
      centre = support.centre;
      least = outside.value;
    }
    if (!(outside.value > support.size * (1 + kLooseness))) break;
    if (!take_in(support, outside.bound)) break;
  }
  return centre;
}

// A slab of the leaves below a node along one normal.
struct Fit {
  PackedSlab packed;
  Vector3d normal;
  double length;
  Greatest<InflatedBound> above, below;  // the leaves that reach farthest

  explicit Fit(const Vector3d& axis) noexcept
      : packed(longest_normal(axis)), normal(normal_of(packed)), length(length_of(normal)) {}

  [[nodiscard]] double width() const noexcept { return above.value + below.value; }

  // Begins with leaves that may not be the farthest.
  void begin(const Fit& other, const Vector3d& from) noexcept {
    above = {height_of(other.above.bound, normal, length, from), other.above.bound};
    below = {height_of(other.below.bound, -normal, length, from), other.below.bound};
  }
  // Returns the direction in which the upper face's support lies from the lower one's, along the
  // slab: the width falls where the normal tilts against it.
  [[nodiscard]] Vector3d across() const noexcept {
    const Vector3d d = difference(above.bound.support_point(normal, length),
                                  below.bound.support_point(-normal, length));
    return difference(d, scaled(dot_in_order(d, normal) / (length * length), normal));
  }
};

// `centre` is that of the node's ball, from which a slab is measured.
PackedSlab thin_slab(const LeafSearch& leaves, const Vector3d& axis, const Vector3d& centre,
                     double pad, double edge) noexcept {
  Fit best(axis);
  leaves.raise_support(best.normal, best.length, centre, best.above);
  leaves.raise_support(-best.normal, best.length, centre, best.below);
  const Vector3d across = best.across();
  const double distance = length_of(across);
  if (distance > 0) {
    const Vector3d tilted = difference(best.normal, scaled(kTilt * best.length / distance, across));
    Fit fit(scaled(1 / length_of(tilted), tilted));
    fit.begin(best, centre);
    if (fit.width() < best.width()) leaves.raise_support(fit.normal, fit.length, centre, fit.above);
    if (fit.width() < best.width())
      leaves.raise_support(-fit.normal, fit.length, centre, fit.below);
    if (fit.width() < best.width()) best = fit;
  }
  return pack_slab({best.packed, -best.below.value, best.above.value}, pad, edge);
}

// Fits the nodes of one level, children of one parent at a time.
class LevelNester {
 public:
  LevelNester(const LinearOctree& octree, const BoundBlocks& bounds, int level, double pad,
              std::span<const Spread> below) noexcept
      : octree_(octree), level_(level), pad_(pad), below_(below), leaves_(octree, bounds, level) {}

  void fit(std::uint32_t parent, BallBlock& balls, SlabBlock* slabs, std::span<Spread> spreads) {
    const std::span<const OctreeNode> parents = octree_.nodes(level_ + 1);
    const auto& [x, y, z] = parents[parent].centre;
    const Vector3d parent_centre(x, y, z);
    const double edge = static_cast<double>(std::uint64_t{1} << level_), parent_edge = 2 * edge;
    const std::uint32_t first = parents[parent].first_child;
    for (std::uint32_t node = first; node < parents[parent + 1].first_child; ++node) {
      const auto slot = static_cast<int>(node - first);
      leaves_.set_node(node);
      PackedBall ball = pack_centre(smallest_centre(leaves_), parent_centre, parent_edge);
      const Vector3d centre = centre_of(ball, parent_centre, parent_edge);
      ball.r = pack_radius(leaves_.farthest(centre).value + pad_, parent_edge);
      balls.set(slot, ball);
      if (slabs == nullptr) continue;
      spreads[node] = spread_of(node);
      slabs->set(slot, thin_slab(leaves_, spreads[node].least_axis(), centre, pad_, edge));
    }
  }

 private:
  [[nodiscard]] Spread spread_of(std::uint32_t node) const {
    Spread spread;
    const std::uint32_t first = octree_.first_child(level_, node);
    for (int slot = 0; slot < octree_.child_count(level_, node); ++slot) {
      if (level_ == 1) {
        spread.add(leaves_.child_ball(slot), leaves_.child_slab(slot));
      } else {
        spread.add(below_[first + static_cast<std::uint32_t>(slot)]);
      }
    }
    return spread;
  }

  const LinearOctree& octree_;
  int level_;
  double pad_;
  std::span<const Spread> below_;
  LeafSearch leaves_;
};

}  // namespace

void nest_bounds(const LinearOctree& octree, double pad, BoundBlocks& bounds, Progress& shown) {
  const bool slabs = !bounds.slabs.empty();
  std::vector<Spread> below, here;  // by node, of the level below and of this one
  for (int level = 1; level <= octree.depth(); ++level) {
    const auto index = static_cast<std::size_t>(level);
    const std::span<const OctreeNode> parents = octree.nodes(level + 1);
    bounds.balls[index].resize(parents.size() - 1);
    if (slabs) {
      bounds.slabs[index].resize(parents.size() - 1);
      below.swap(here);
      here.resize(octree.node_count(level));
    }
    parallel_for(parents.size() - 1, kGrain, [&](std::size_t begin, std::size_t end) {
      shown.check();
      LevelNester nester(octree, bounds, level, pad, below);
      for (std::size_t parent = begin; parent < end; ++parent) {
        nester.fit(static_cast<std::uint32_t>(parent), bounds.balls[index][parent],
                   slabs ? &bounds.slabs[index][parent] : nullptr, here);
      }
      shown.add(parents[end].first_child - parents[begin].first_child);
    });
  }
}

}  // namespace ist
