#include "ist/query/exact/cluster_search.h"

#include <cmath>

namespace ist {

ClusterSearch::ClusterSearch(const TriangleClusters& fixed, const TriangleClusters& moving,
                             const ClusterKernels& kernels)
    : fixed_(fixed), moving_(moving), kernels_(kernels) {
  // A step is from a moving level to the one below, with fixed nodes of the same level, or of the
  // fixed root's where that is lower; their children may be all nodes below.
  const auto nodes_at = [&](int level) -> std::size_t {
    return fixed.node_count(std::clamp(level, 0, fixed.root_level()));
  };
  const int top = moving.root_level() + 1;
  for (int level = 0; level <= top; ++level) {
    Step& step = steps_.emplace_back();
    step.near.resize(level == top ? nodes_at(level - 1) : kClusterWidth * nodes_at(level));
    step.nodes.resize(nodes_at(level - 1));
  }
  for (int level = 0; level < top; ++level) {
    Step& step = step_at(level);
    step.lists = {step.near.data(), nodes_at(level), {}};
  }
}

void ClusterSearch::begin(const ClusterPose& pose, bool measures_rest) noexcept {
  measures_rest_ = measures_rest;
  step_ = {pose,
           fixed_at(0),
           fixed_.clusters().data(),
           moving_.clusters().data(),
           fixed_.triangle_count(),
           moving_.triangle_count()};
  nearest_left_ = std::numeric_limits<double>::infinity();
}

bool ClusterSearch::find_lists(Step& step, std::uint32_t lanes, int fixed_level, NodeList nodes,
                               float reach, ClusterBudget& budget) const noexcept {
  std::fill_n(step.lists.counts, kClusterWidth, 0U);
  for (std::size_t k = 0; k < nodes.count; k += kPart) {
    const NodeList part{nodes.nodes + k, std::min(kPart, nodes.count - k)};
    if (!budget.allows(lanes * part.count)) return false;
    kernels_.meet_nodes(step.turned, lanes, fixed_at(fixed_level), part, reach, step.lists);
    budget.spend(lanes * part.count);
  }
  return true;
}

bool ClusterSearch::find_children(Step& step, std::uint32_t lane, int level, NodeList parents,
                                  float reach, ClusterBudget& budget,
                                  NodeList& found) const noexcept {
  const FixedNodes children = fixed_at(level);
  found = {step.nodes.data(), 0};
  for (std::size_t k = 0; k < parents.count; k += kPart) {
    const NodeList part{parents.nodes + k, std::min(kPart, parents.count - k)};
    const std::uint64_t tests = children.children_of(part);
    if (!budget.allows(tests)) return false;
    found.count += kernels_.meet_children(step.turned, lane, children, part, reach,
                                          step.nodes.data() + found.count);
    budget.spend(tests);
  }
  return true;
}

// Lanes whose lists are empty stay at the end, in any order.
ClusterSearch::Order ClusterSearch::most_first(const LaneLists& lists) noexcept {
  Order order;
  std::size_t count = 0, empty = kClusterWidth;
  for (std::uint8_t lane = 0; lane < kClusterWidth; ++lane) {
    if (lists.counts[lane] == 0) {
      order[--empty] = lane;
      continue;
    }
    std::size_t at = count++;
    for (; at > 0 && lists.counts[lane] > lists.counts[order[at - 1]]; --at) {
      order[at] = order[at - 1];
    }
    order[at] = lane;
  }
  return order;
}

// Notes how near the balls of a child and of some fixed nodes are.
void ClusterSearch::leave(const Step& step, std::uint32_t lane, int fixed_level,
                          NodeList nodes) noexcept {
  if (!measures_rest_) return;
  const TurnedBlock& from = step.turned;
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const std::uint32_t node = nodes.nodes[k];
    const NodeBlock& block = fixed_.bounds(fixed_level)[node / kClusterWidth];
    const std::uint32_t at = node % kClusterWidth;
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double apart =
          (double{from.centre[i][lane]} - double{block.centre[i][at]}) + double{from.rest[i][lane]};
      squared += apart * apart;
    }
    const double radii = double{from.radius[lane]} + double{block.radius[at]};
    nearest_left_ = std::min(nearest_left_, std::sqrt(squared) - radii - step_.pose.error);
  }
}

std::size_t ClusterSearch::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Step& step : steps_) {
    bytes += sizeof(Step) + (step.near.size() + step.nodes.size()) * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace ist
