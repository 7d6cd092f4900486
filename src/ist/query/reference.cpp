#include "ist/query/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/query/contact_order.h"
#include "ist/query/query_rules.h"

namespace ist {
namespace {

double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// Whether a ball lies outside a slab; `centre` is the ball's, from that of the slab's own ball.
bool beyond(const Slab& slab, const Eigen::Vector3d& centre, double radius) noexcept {
  return std::abs(dot(slab.normal, centre) - slab.offset) > slab.half + radius;
}

}  // namespace

ReferenceQuery::ReferenceQuery(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, SphereSource source)
    : fixed_(fixed), moving_(moving), policy_(policy) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
  const ScopedFloatEnvironment environment;
  if (source == SphereSource::kSaved) {
    saved_fixed_ = save_spheres(fixed, policy);
    saved_moving_ = save_spheres(moving, policy);
  }
}

QueryResult ReferenceQuery::collide(const Eigen::Isometry3d& pose, std::span<Contact> out) {
  const ScopedFloatEnvironment environment;
  QueryResult result;
  const std::optional<RelativePose> relative =
      relative_pose(pose, fixed_.lattice(), moving_.lattice());
  if (!relative) {
    result.status = QueryStatus::kInvalidPose;
    result.complete = false;
    return result;
  }
  pose_ = *relative;
  const double reach = fixed_.reach() + moving_.reach();
  const double farthest = pose_.translation.cwiseAbs().maxCoeff();
  slack_ = slack_in_double(reach, farthest);
  tests_ = 0;
  found_.clear();

  const Node a = root(fixed_, saved_fixed_);
  Node b = root(moving_, saved_moving_);
  to_fixed_frame(b);
  // Decided by one coordinate where they are far apart, because the square of a distance overflows.
  if (touch(a, b) && farthest <= reach + slack_) descend(a, b);

  // Those of one fixed leaf were found in order: the way down opens moving nodes in order.
  sort_by_fixed(found_, sorted_);
  std::copy_n(found_.begin(), std::min(found_.size(), out.size()), out.begin());
  result.contacts = found_.size();
  result.truncated = found_.size() > out.size();
  result.sphere_tests = tests_;
  result.pad = 2 * slack_;
  return result;
}

double ReferenceQuery::resolution(const QueryResult& result) const noexcept {
  const ScopedFloatEnvironment environment;
  return resolution_of(result, fixed_, moving_, policy_);
}

void ReferenceQuery::bound(const SphereTree& tree, const SavedSpheres& saved, std::uint32_t parent,
                           int slot, Node& node) const {
  if (!saved.empty()) {
    node.ball = saved[static_cast<std::size_t>(node.level)][node.index];
  } else if (is_implicit(policy_)) {
    node.ball = tree.ball(policy_, node.level, node.index, node.cube_centre);
  } else {
    node.ball = tree.saved_ball(node.level, parent, slot);
  }
  if (policy_ == SpherePolicy::kSlab) node.slab = tree.saved_slab(node.level, parent, slot);
}

ReferenceQuery::Node ReferenceQuery::root(const SphereTree& tree, const SavedSpheres& saved) const {
  Node node{tree.depth(), 0, Eigen::Vector3d::Zero(), {}, {}};
  bound(tree, saved, 0, 0, node);
  return node;
}

void ReferenceQuery::open(const SphereTree& tree, const SavedSpheres& saved, const Node& node,
                          Children& children) const {
  const LinearOctree& octree = tree.octree();
  const double half = 0.5 * static_cast<double>(std::uint64_t{1} << (node.level - 1));
  children.count = 0;
  std::uint32_t index = octree.first_child(node.level, node.index);
  for (unsigned bits = octree.mask(node.level, node.index); bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    const int slot = children.count++;
    Node& child = children.nodes[slot];
    child.level = node.level - 1;
    child.index = index++;
    child.cube_centre = {node.cube_centre[0] + ((k & 1) != 0 ? half : -half),
                         node.cube_centre[1] + ((k & 2) != 0 ? half : -half),
                         node.cube_centre[2] + ((k & 4) != 0 ? half : -half)};
    bound(tree, saved, node.index, slot, child);
  }
}

void ReferenceQuery::to_fixed_frame(Node& node) const noexcept {
  const Eigen::Matrix3d& r = pose_.rotation;
  const auto turned = [&r](const Eigen::Vector3d& v) {
    return Eigen::Vector3d((r(0, 0) * v[0] + r(0, 1) * v[1]) + r(0, 2) * v[2],
                           (r(1, 0) * v[0] + r(1, 1) * v[1]) + r(1, 2) * v[2],
                           (r(2, 0) * v[0] + r(2, 1) * v[1]) + r(2, 2) * v[2]);
  };
  node.ball.centre = turned(node.ball.centre) + pose_.translation;
  if (policy_ == SpherePolicy::kSlab) node.slab.normal = turned(node.slab.normal);
}

// Rejected by >, so that what cannot be compared is kept.
bool ReferenceQuery::touch(const Node& a, const Node& b) noexcept {
  ++tests_;
  const Eigen::Vector3d apart = b.ball.centre - a.ball.centre;
  const double reach = (a.ball.radius + b.ball.radius) + slack_;
  if (dot(apart, apart) > reach * reach) return false;
  return policy_ != SpherePolicy::kSlab || !(beyond(a.slab, apart, b.ball.radius + slack_) ||
                                             beyond(b.slab, -apart, a.ball.radius + slack_));
}

void ReferenceQuery::descend(const Node& a, const Node& b) {
  if (a.level == 0 && b.level == 0) {
    found_.push_back({a.index, b.index});
    return;
  }
  const double edge_a = fixed_.lattice().edge(a.level), edge_b = moving_.lattice().edge(b.level);
  const bool open_a = opens(a.level, edge_a, b.level, edge_b);
  const bool open_b = opens(b.level, edge_b, a.level, edge_a);
  Children of_a, of_b;
  if (open_a) {
    open(fixed_, saved_fixed_, a, of_a);
  } else {
    of_a.count = 1;
    of_a.nodes[0] = a;
  }
  if (open_b) {
    open(moving_, saved_moving_, b, of_b);
    for (int j = 0; j < of_b.count; ++j) to_fixed_frame(of_b.nodes[j]);
  } else {
    of_b.count = 1;
    of_b.nodes[0] = b;
  }
  for (int i = 0; i < of_a.count; ++i) {
    for (int j = 0; j < of_b.count; ++j) {
      if (touch(of_a.nodes[i], of_b.nodes[j])) descend(of_a.nodes[i], of_b.nodes[j]);
    }
  }
}

}  // namespace ist
