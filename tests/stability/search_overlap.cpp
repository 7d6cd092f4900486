#include "stability/search_overlap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ist/query/contacts/contact_leaf.h"
#include "ist/query/query_rules.h"
#include "ist/tree/tree_parts.h"
#include "verify/read_bounds.h"

namespace ist::test {
namespace {

double overlap(SpherePolicy policy, const NodeBound& a, const NodeBound& b) {
  const double balls = a.radius + b.radius - (a.centre - b.centre).norm();
  return policy == SpherePolicy::kSlab ? std::min(balls, slab_overlap(a, b)) : balls;
}

NodeBound leaf_bound(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf) {
  return read_bound(tree, policy, 0, leaf, parent_of(tree.parts().octree, 0, leaf));
}

// A leaf's bound, its parent's, and so on up to the root's.
std::vector<NodeBound> bounds_over(const SphereTree& tree, SpherePolicy policy,
                                   std::uint32_t node) {
  std::vector<NodeBound> bounds;
  for (int level = 0; level <= tree.depth(); ++level) {
    const std::uint32_t parent = parent_of(tree.parts().octree, level, node);
    bounds.push_back(read_bound(tree, policy, level, node, parent));
    node = parent;
  }
  return bounds;
}

}  // namespace

double leaf_overlap(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                    const RelativePose& pose, const LeafPair& pair) {
  return overlap(policy, leaf_bound(fixed, policy, pair.fixed),
                 leaf_bound(moving, policy, pair.moving).in(pose));
}

double search_overlap(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                      const Eigen::Isometry3d& pose, const LeafPair& pair) {
  const RelativePose relative =
      relative_pose(pose, fixed.parts().lattice, moving.parts().lattice).value();
  if (policy != SpherePolicy::kTable) return leaf_overlap(fixed, moving, policy, relative, pair);
  const std::vector<NodeBound> a = bounds_over(fixed, policy, pair.fixed),
                               b = bounds_over(moving, policy, pair.moving);
  double least = HUGE_VAL;
  for (int i = fixed.depth(), j = moving.depth();;) {
    least = std::min(least, overlap(policy, a[static_cast<std::size_t>(i)],
                                    b[static_cast<std::size_t>(j)].in(relative)));
    if (i == 0 && j == 0) return least;
    const double edge_a = fixed.parts().lattice.edge(i), edge_b = moving.parts().lattice.edge(j);
    const bool open_a = descends(i, edge_a, j, edge_b), open_b = descends(j, edge_b, i, edge_a);
    i -= open_a ? 1 : 0;
    j -= open_b ? 1 : 0;
  }
}

}  // namespace ist::test
