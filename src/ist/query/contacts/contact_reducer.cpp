#include "ist/query/contacts/contact_reducer.h"

#include <array>

#include "ist/base/throw_error.h"

namespace ist {
namespace {

// The units of leaf sums, and the way to fixed mesh coordinates.
struct LeafSumUnits {
  double area;         // of a weight, mesh units²
  double lever;        // of a position, mesh units
  double least, most;  // the least and the greatest depth, mesh units
  RelativePose pose;
  Eigen::Vector3d origin;  // of the fixed tree's frame
};

// Normals whose sum is shorter than this part of their weight have no common direction.
constexpr double kCancelled = 1e-5;
constexpr std::size_t kMarked = 7;  // the deepest and six extremes

double length_of(const Eigen::Vector3d& v) noexcept { return std::sqrt(dot_in_order(v, v)); }

Eigen::Vector3d position_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  return sum(units.origin, moved(units.pose, scaled(units.lever / node.weight, node.position)));
}

double depth_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  return std::clamp(units.least + node.depth / node.weight, units.least, units.most);
}

Contact point_of(const LeafSum& node, const LeafSumUnits& units) noexcept {
  const double length = length_of(node.force);
  const Eigen::Vector3d first(node.first[0], node.first[1], node.first[2]);
  const Eigen::Vector3d normal = length <= kCancelled * node.weight
                                     ? scaled(1 / length_of(first), first)
                                     : scaled(1 / length, node.force);
  return {position_of(node, units), turned(units.pose, normal), depth_of(node, units),
          units.area * node.weight};
}

// The places of the nodes that stay apart, each once.
struct Marks {
  std::array<std::size_t, kMarked> places;
  std::size_t count = 0;

  void add(std::size_t place) noexcept {
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(places.begin(), end, place) == end) places[count++] = place;
  }
};

// Of equal nodes the first is marked.
Marks find_marks(std::span<const LeafSum> nodes, const LeafSumUnits& units) noexcept {
  std::array<std::size_t, kMarked> best{};
  std::array<double, kMarked> most{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const LeafSum& node = nodes[i];
    const Eigen::Vector3d p = position_of(node, units);
    const std::array<double, kMarked> of{
        depth_of(node, units), -p[0], p[0], -p[1], p[1], -p[2], p[2]};
    for (std::size_t k = 0; k < kMarked; ++k) {
      if (i > 0 && of[k] <= most[k]) continue;
      most[k] = of[k];
      best[k] = i;
    }
  }
  Marks marks;
  for (const std::size_t place : best) marks.add(place);
  return marks;
}

// Reduces leaf sums to contacts, at most as many as `out` has room for, in fixed mesh coordinates.
// Returns their number.
//
// If they fit, there is one contact for each node. Otherwise the deepest node and the extreme ones
// along x, y and z stay apart, as many of these seven as leave one place free; the others are
// merged by common octree ancestor, at the finest level at which they fit. A single contact is the
// deepest node's, with the weight of all. The contacts' weights always add up to the weight of all
// nodes.
//
// The order: the deepest, the six extreme ones, each node once, then the others in the order of
// the fixed tree. The nodes of `sums` are consumed. Cost: 15 ns a node; no allocation.
std::size_t cluster(LeafSums& sums, const LeafSumUnits& units, std::span<Contact> out) noexcept {
  if (sums.nodes().empty() || out.empty()) return 0;
  Marks marks = find_marks(sums.nodes(), units);
  const Contact deepest = point_of(sums.nodes()[marks.places[0]], units);
  if (sums.nodes().size() > out.size()) marks.count = std::min(marks.count, out.size() - 1);

  std::size_t count = 0;
  const auto marked = std::span(marks.places).first(marks.count);
  for (const std::size_t place : marked) out[count++] = point_of(sums.nodes()[place], units);
  sums.take_out(marked);
  while (sums.nodes().size() > out.size() - count) sums.coarsen();
  for (const LeafSum& node : sums.nodes()) out[count++] = point_of(node, units);
  if (out.size() == 1) {
    const double weight = out[0].weight;
    out[0] = deepest;
    out[0].weight = weight;
  }
  return count;
}

}  // namespace

}  // namespace ist

namespace ist::detail {
namespace {

void require_in_range(const char* name, double value, double most) {
  if (value >= 0 && value <= most) return;  // no NaN
  throw_error(ErrorCode::kArgumentInvalid, "manifold option {} is {}: give a number from 0 to {}",
              name, value, most);
}

const SphereTree& with(const SphereTree& tree, SpherePolicy policy, const char* body) {
  require_voxels(tree, body);
  tree.require(policy, body);
  return tree;
}

}  // namespace

void ContactReducer::check(const ManifoldOptions& options) {
  require_in_range("points", static_cast<double>(options.points), double{kMostItems});
  require_in_range("max_leaves", static_cast<double>(options.max_leaves), double{kMostItems});
  require_in_range("margin", options.margin, 2);
  require_in_range("reach", options.reach, 1);
}

ContactWork::ContactWork(const ManifoldOptions& options, std::size_t leaves) {
  if (options.points == 0) return;
  leaf_sums.emplace(leaves);
  adder.stream = &*leaf_sums;
}

ContactReducer::ContactReducer(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, const ManifoldOptions& options,
                               const ScopedFloatEnvironment&)
    : ContactReducer(with(fixed, policy, "fixed"), policy, options) {
  bytes_ = bytes_for(fixed, moving, options);
  own_ = std::make_unique<ContactWork>(options, most_leaves(fixed, options));
  bind(fixed, with(moving, policy, "moving"), policy, *own_);
}

ContactReducer::ContactReducer(const SphereTree& any, SpherePolicy policy,
                               const ManifoldOptions& options)
    : fixed_(any),
      moving_(any),
      options_(options),
      policy_(policy),
      scale_(any, any),
      rates_{},
      bytes_(options.points * sizeof(Contact)) {
  check(options);
  points_.resize(options.points);
}

void ContactReducer::bind(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                          ContactWork& work) noexcept {
  if (!fits(fixed, moving, policy)) {
    fixed_ = fixed;
    moving_ = moving;
    policy_ = policy;
  }
  scale_ = ContactScale(fixed, moving, options_.margin, options_.reach);
  rates_ = contact_rates(fixed, moving, policy, scale_);
  work_ = &work;
  work.adder.rule = contact_rule(scale_, rates_.lever);
  if (work.leaf_sums) {
    work.leaf_sums->bind(voxels_of(fixed).octree, std::max<std::size_t>(options_.max_leaves, 1));
  }
  count_ = 0;
  sums_ = {};
  sums_.about = fixed.origin();
}

void ContactReducer::clear() noexcept {
  work_->adder.clear();
  if (work_->leaf_sums) work_->leaf_sums->clear();
  count_ = 0;
  sums_ = {};
  sums_.about = fixed_.origin();
}

void ContactReducer::finish(const RelativePose& pose, bool complete) noexcept {
  const ContactRule& rule = work_->adder.rule;
  const ContactTotals& totals = work_->adder.totals;
  // The units are those that the kernels used, rounding and all.
  const double weight = scale_.area / kContactUnit, lever = 0.5 / double{rule.half_per_lever},
               range = 1 / double{rule.per_range};
  const auto vector = [&](ContactSum place, double unit) {
    const auto at = [&](std::size_t i) {
      return unit * static_cast<double>(totals.sum[place + i]);
    };
    return turned(pose, {at(0), at(1), at(2)});
  };
  // Torques about the moving frame's origin become such about the fixed one's.
  const auto wrench = [&](ContactSum force, ContactSum torque, double unit) {
    const Eigen::Vector3d f = vector(force, unit);
    return Wrench{f, sum(vector(torque, lever * unit), cross_in_order(pose.translation, f))};
  };
  sums_.pairs = totals.counted;
  sums_.weight = weight * static_cast<double>(totals.sum[kWeightSum]);
  sums_.pressure = wrench(kForceSum, kTorqueSum, weight);
  sums_.spring = wrench(kSpringSum, kSpringTorqueSum, range * weight);
  if (!work_->leaf_sums || !complete) return;
  LeafSums& leaf_sums = *work_->leaf_sums;
  leaf_sums.close();
  const LeafSumUnits units{weight, lever, scale_.least_depth(), scale_.size, pose, sums_.about};
  count_ = cluster(leaf_sums, units, points_);
}

std::size_t ContactReducer::most_leaves(const SphereTree& fixed,
                                        const ManifoldOptions& options) noexcept {
  return std::min<std::size_t>(std::max<std::size_t>(options.max_leaves, 1), fixed.leaf_count());
}

std::size_t ContactReducer::bytes_for(const SphereTree& fixed, const SphereTree& /*moving*/,
                                      const ManifoldOptions& options) {
  check(options);
  require_voxels(fixed, "fixed");
  return bytes_of_work(options, most_leaves(fixed, options)) + options.points * sizeof(Contact);
}

}  // namespace ist::detail
