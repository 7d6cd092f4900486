#include "ablation/pointer_query.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "ist/base/float_environment.h"
#include "ist/query/query_rules.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/bounds.h"
#include "ist/tree/tree_parts.h"

namespace ist::bench {
namespace {

double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

bool beyond(const Slab& slab, const Eigen::Vector3d& centre, double radius) noexcept {
  return std::abs(dot(slab.normal, centre) - slab.offset) > slab.half + radius;
}

struct NoSlab {};

// Only kSlab carries slabs.
template <bool kSlabs>
struct PointerVisit {
  const PointerNode* node;
  Ball ball;                                                            // in the fixed tree's frame
  [[no_unique_address]] std::conditional_t<kSlabs, Slab, NoSlab> slab;  // in the fixed tree's frame
};

template <bool kSlabs>
struct PointerChildren {
  int count;
  PointerVisit<kSlabs> visits[8];
};

// One descent of both trees.
template <bool kSlabs>
class PointerDescent {
  using Visit = PointerVisit<kSlabs>;
  using Children = PointerChildren<kSlabs>;
  using Body = PointerQuery::Body;

 public:
  PointerDescent(const Body& fixed, const Body& moving, SpherePolicy policy,
                 const RelativePose& pose, std::vector<LeafPair>& found)
      : fixed_(fixed), moving_(moving), policy_(policy), pose_(pose), found_(found) {
    const double reach = fixed.tree.bounding_radius() + moving.tree.bounding_radius();
    const double farthest = pose.translation.cwiseAbs().maxCoeff();
    pad_ = pad_in_double(reach, farthest);
    const Visit a = visit(fixed.tree, fixed.pointers.root(), 0, 0);
    Visit b = visit(moving.tree, moving.pointers.root(), 0, 0);
    to_fixed_frame(b);
    if (touch(a, b) && farthest <= reach + pad_) descend(a, b);
  }

  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }
  [[nodiscard]] double pad() const noexcept { return pad_; }

 private:
  // `node` is child `slot` of `parent`, by the parent's index in the linear octree.
  [[nodiscard]] Visit visit(const SphereTree& tree, const PointerNode& node, std::uint32_t parent,
                            int slot) const {
    Visit visit;
    visit.node = &node;
    visit.ball = is_implicit(policy_) ? implicit_ball(policy_, voxels_of(tree).lattice, node.level,
                                                      node.cube_centre, node.mask)
                                      : voxels_of(tree).saved_ball(node.level, parent, slot);
    if constexpr (kSlabs) visit.slab = voxels_of(tree).saved_slab(node.level, parent, slot);
    return visit;
  }

  void open(const SphereTree& tree, const PointerNode& node, Children& children) const {
    children.count = 0;
    for (const auto& child : node.children) {
      if (child == nullptr) continue;
      children.visits[children.count] = visit(tree, *child, node.index, children.count);
      ++children.count;
    }
  }

  void to_fixed_frame(Visit& visit) const noexcept {
    const Eigen::Matrix3d& r = pose_.rotation;
    const auto turned = [&r](const Eigen::Vector3d& v) {
      return Eigen::Vector3d((r(0, 0) * v[0] + r(0, 1) * v[1]) + r(0, 2) * v[2],
                             (r(1, 0) * v[0] + r(1, 1) * v[1]) + r(1, 2) * v[2],
                             (r(2, 0) * v[0] + r(2, 1) * v[1]) + r(2, 2) * v[2]);
    };
    visit.ball.centre = turned(visit.ball.centre) + pose_.translation;
    if constexpr (kSlabs) visit.slab.normal = turned(visit.slab.normal);
  }

  [[nodiscard]] bool touch(const Visit& a, const Visit& b) noexcept {
    ++tests_;
    const Eigen::Vector3d apart = b.ball.centre - a.ball.centre;
    const double reach = (a.ball.radius + b.ball.radius) + pad_;
    if (dot(apart, apart) > reach * reach) return false;
    if constexpr (kSlabs) {
      return !(beyond(a.slab, apart, b.ball.radius + pad_) ||
               beyond(b.slab, -apart, a.ball.radius + pad_));
    }
    return true;
  }

  void descend(const Visit& a, const Visit& b) {
    if (a.node->level == 0 && b.node->level == 0) {
      found_.push_back({a.node->index, b.node->index});
      return;
    }
    const double edge_a = voxels_of(fixed_.tree).lattice.edge(a.node->level);
    const double edge_b = voxels_of(moving_.tree).lattice.edge(b.node->level);
    Children of_a, of_b;
    if (descends(a.node->level, edge_a, b.node->level, edge_b)) {
      open(fixed_.tree, *a.node, of_a);
    } else {
      of_a.count = 1;
      of_a.visits[0] = a;
    }
    if (descends(b.node->level, edge_b, a.node->level, edge_a)) {
      open(moving_.tree, *b.node, of_b);
      for (int j = 0; j < of_b.count; ++j) to_fixed_frame(of_b.visits[j]);
    } else {
      of_b.count = 1;
      of_b.visits[0] = b;
    }
    for (int i = 0; i < of_a.count; ++i) {
      for (int j = 0; j < of_b.count; ++j) {
        if (touch(of_a.visits[i], of_b.visits[j])) descend(of_a.visits[i], of_b.visits[j]);
      }
    }
  }

  const Body &fixed_, &moving_;
  const SpherePolicy policy_;
  const RelativePose pose_;
  double pad_ = 0;  // mesh units: the error that a test allows for
  std::uint64_t tests_ = 0;
  std::vector<LeafPair>& found_;
};

}  // namespace

PointerTree::PointerTree(const LinearOctree& octree)
    : root_(make(octree, octree.depth(), 0, Eigen::Vector3d::Zero())) {}

std::unique_ptr<PointerNode> PointerTree::make(const LinearOctree& octree, int level,
                                               std::uint32_t index,
                                               const Eigen::Vector3d& cube_centre) {
  ++nodes_;
  auto node = std::make_unique<PointerNode>();
  node->cube_centre = cube_centre;
  node->level = level;
  node->index = index;
  node->mask = level == 0 ? std::uint8_t{0} : octree.mask(level, index);
  if (level == 0) return node;
  const double half = 0.5 * static_cast<double>(std::uint64_t{1} << (level - 1));
  std::uint32_t child = octree.first_child(level, index);
  for (unsigned k = 0; k < 8; ++k) {
    if ((node->mask >> k & 1) == 0) continue;
    node->children[k] = make(octree, level - 1, child++,
                             {cube_centre[0] + ((k & 1) != 0 ? half : -half),
                              cube_centre[1] + ((k & 2) != 0 ? half : -half),
                              cube_centre[2] + ((k & 4) != 0 ? half : -half)});
  }
  return node;
}

QueryResult PointerQuery::leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
  const ScopedFloatEnvironment environment;
  const std::optional<RelativePose> relative =
      relative_pose(pose, parts_of(fixed_.tree).origin, parts_of(moving_.tree).origin);
  if (!relative) {
    QueryResult result;
    result.status = QueryStatus::kInvalidPose;
    result.complete = false;
    return result;
  }
  return policy_ == SpherePolicy::kSlab ? search<true>(*relative, out)
                                        : search<false>(*relative, out);
}

template <bool kSlabs>
QueryResult PointerQuery::search(const RelativePose& pose, std::span<LeafPair> out) {
  found_.clear();
  const PointerDescent<kSlabs> descent(fixed_, moving_, policy_, pose, found_);
  std::stable_sort(found_.begin(), found_.end(),
                   [](const LeafPair& x, const LeafPair& y) { return x.fixed < y.fixed; });
  std::copy_n(found_.begin(), std::min(found_.size(), out.size()), out.begin());
  QueryResult result;
  result.leaf_pairs = found_.size();
  result.truncated = found_.size() > out.size();
  result.sphere_tests = descent.tests();
  result.pad = 2 * descent.pad();
  return result;
}

}  // namespace ist::bench
