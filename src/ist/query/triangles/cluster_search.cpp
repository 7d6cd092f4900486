#include "ist/query/triangles/cluster_search.h"

#include <cmath>

namespace ist {

// A step is from a moving level to the one below, with fixed nodes of the same level, or of the
// fixed root's where that is lower; their children may be all nodes below.
ClusterSearch::Lengths ClusterSearch::step_lengths(const TriangleClusters& fixed,
                                                   int moving_root_level, int level) noexcept {
  if (level == 0) return {};  // clusters have no children
  const auto nodes_at = [&](int at) -> std::size_t {
    return fixed.node_count(std::clamp(at, 0, fixed.root_level()));
  };
  const bool top = level == moving_root_level + 1;
  const std::size_t lanes = top ? 1 : kClusterWidth;
  return {nodes_at(level) + kClusterWidth,
          lanes * nodes_at(top ? level - 1 : level) + kClusterWidth,
          lanes * nodes_at(level - 1) + kClusterWidth};
}

ClusterSearch::ClusterSearch(const TriangleClusters& fixed, const TriangleClusters& moving,
                             const ClusterKernels& kernels, std::size_t items)
    : kernels_(kernels),
      items_(std::max(items, items_for(fixed, moving.root_level()))),
      steps_(kMostSteps) {
  bind(fixed, moving);
}

void ClusterSearch::bind(const TriangleClusters& fixed, const TriangleClusters& moving) noexcept {
  fixed_ = &fixed;
  moving_ = &moving;
  std::uint32_t* next = items_.data();
  for (int level = 0; level <= moving.root_level() + 1; ++level) {
    const Lengths lengths = step_lengths(fixed, moving.root_level(), level);
    Step& step = step_at(level);
    step.bits = next;
    step.near = step.bits + lengths.bits;
    step.deeper = step.near + lengths.near;
    next = step.deeper + lengths.deeper;
  }
}

std::size_t ClusterSearch::items_for(const TriangleClusters& fixed,
                                     int moving_root_level) noexcept {
  std::size_t items = 0;
  for (int level = 0; level <= moving_root_level + 1; ++level) {
    const Lengths lengths = step_lengths(fixed, moving_root_level, level);
    items += lengths.bits + lengths.near + lengths.deeper;
  }
  return items;
}

void ClusterSearch::begin(const ClusterPose& pose, const Sweep* sweep) noexcept {
  sweep_ = sweep;
  step_ = {pose,
           fixed_at(0),
           fixed_->clusters().data(),
           moving_->clusters().data(),
           fixed_->triangle_count(),
           moving_->triangle_count()};
}

bool ClusterSearch::descend_to_root(float reach, BudgetMeter& meter, int& level,
                                    LaneNodes& nodes) noexcept {
  // Above its root the moving tree has a node of one child.
  Step& top = step_at(moving_->root_level() + 1);
  turn(moving_->bounds(moving_->root_level())[0], top.turned);
  level = fixed_->root_level();
  nodes = {top.near, 1};
  top.near[0] = 0;
  while (level > moving_->root_level()) {
    LaneNodes children{};
    if (!find_children(top, --level, nodes, reach, meter, children)) {
      note_untested(top, level + 1, nodes);
      return false;
    }
    std::copy_n(children.codes, children.count, top.near);
    nodes.count = children.count;
  }
  return true;
}

// Lists the lanes that are near some of the nodes.
bool ClusterSearch::find_near(Step& step, std::uint32_t lanes, int fixed_level, LaneNodes nodes,
                              float reach, BudgetMeter& meter, LaneNodes& found) noexcept {
  bool allowed = true;
  std::size_t k = 0;
  for (; k < nodes.count; k += kPart) {
    const LaneNodes part = nodes.part(k, kPart);
    allowed = meter.allows(lanes * part.count);
    if (!allowed) break;
    kernels_.meet_nodes(step.turned, lanes, fixed_at(fixed_level), part, reach, step.bits + k);
    meter.spend(lanes * part.count);
  }
  if (!allowed) std::fill_n(step.bits, nodes.count, (1U << lanes) - 1);  // all are left
  found = {step.near, kernels_.list_lanes(nodes, step.bits, step.near)};
  if (!allowed) note_untested(step, fixed_level, found);
  return allowed;
}

// Lists the children that may be near the lanes of their parents.
bool ClusterSearch::find_children(Step& step, int level, LaneNodes parents, float reach,
                                  BudgetMeter& meter, LaneNodes& found) const noexcept {
  const FixedNodes children = fixed_at(level);
  found = {step.deeper, 0};
  const std::size_t most = meter.is_limited() ? kPart : parents.count;
  for (std::size_t k = 0; k < parents.count; k += most) {
    const LaneNodes part = parents.part(k, most);
    const std::uint64_t tests = children.children_of(part);
    if (!meter.allows(tests)) return false;
    found.count +=
        kernels_.meet_children(step.turned, children, part, reach, step.deeper + found.count);
    meter.spend(tests);
  }
  return true;
}

ClusterSearch::Groups ClusterSearch::by_lanes(LaneNodes pairs, bool most_first) noexcept {
  Groups groups;
  for (std::size_t first = 0; first < pairs.count;) {
    std::size_t last = first + 1;
    while (last < pairs.count && pairs.lane(last) == pairs.lane(first)) ++last;
    const LaneNodes group = pairs.part(first, last - first);
    std::size_t at = groups.count++;
    for (; most_first && at > 0 && group.count > groups.pairs[at - 1].count; --at) {
      groups.pairs[at] = groups.pairs[at - 1];
    }
    groups.pairs[at] = group;
    first = last;
  }
  return groups;
}

// Notes the distances of pairs of nodes that the search does not test any more.
void ClusterSearch::note_untested(const Step& step, int fixed_level, LaneNodes pairs) noexcept {
  if (!measures_rest_) return;
  const TurnedBlock& from = step.turned;
  for (std::size_t k = 0; k < pairs.count; ++k) {
    const std::uint32_t lane = pairs.lane(k), node = pairs.node(k), at = node % kClusterWidth;
    const NodeBlock& block = fixed_->bounds(fixed_level)[node / kClusterWidth];
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double apart =
          (double{from.centre[i][lane]} - double{block.centre[i][at]}) + double{from.rest[i][lane]};
      squared += apart * apart;
    }
    const double radii = double{from.radius[lane]} + double{block.radius[at]};
    const double centres = std::sqrt(squared);
    // The rest of a centre is rounded to float: far less than this part of the sizes.
    const double rounding = double{kNodeRounding} * (radii + centres);
    nearest_left_ = std::min(nearest_left_, centres - radii - rounding - step_.pose.error);
  }
}

}  // namespace ist
