#include "ist/query/reference.h"

#include <algorithm>
#include <bit>

#include "ist/base/float_environment.h"

namespace ist {
namespace {

// What a test errs by, in parts of the two reaches and the translation t between the frames, with u
// = 2⁻⁵³: a centre 4u of its length, and the moving one 6u more, for √3 · 3u of rotation and a sum;
// t 3u of its own; the distance and the sum of radii, equal where it matters, 5u; the rotation's
// being a little off orthonormal, 4u of a moving radius. No length is counted for more than 11u.
constexpr double kRounding = 16 * 0x1p-53;

// A cube with more than this times the other's edge is opened alone.
constexpr double kLarger = 1.4142135623730951;

}  // namespace

ReferenceQuery::ReferenceQuery(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, SphereSource source)
    : fixed_(fixed), moving_(moving), policy_(policy) {
  fixed.require(policy, "fixed");
  moving.require(policy, "moving");
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
  slack_ = kRounding * reach + kRounding * kSqrt3 * farthest;
  tests_ = 0;
  found_.clear();

  const Node a = root(fixed_, saved_fixed_);
  Node b = root(moving_, saved_moving_);
  to_fixed_frame(b);
  // Decided by one coordinate where they are far apart, because the square of a distance overflows.
  if (touch(a.ball, b.ball) && farthest <= reach + slack_) descend(a, b);

  // One number to compare, for a branch on each of two could not be foreseen.
  const auto key = [](const Contact& c) { return std::uint64_t{c.fixed} << 32 | c.moving; };
  std::sort(found_.begin(), found_.end(),
            [key](const Contact& p, const Contact& q) { return key(p) < key(q); });
  std::copy_n(found_.begin(), std::min(found_.size(), out.size()), out.begin());
  result.contacts = found_.size();
  result.truncated = found_.size() > out.size();
  result.sphere_tests = tests_;
  result.pad = 2 * slack_;
  return result;
}

Ball ReferenceQuery::ball(const SphereTree& tree, const SavedSpheres& saved,
                          const Node& node) const {
  return saved.empty() ? tree.ball(policy_, node.level, node.index, node.cube_centre)
                       : saved[static_cast<std::size_t>(node.level)][node.index];
}

ReferenceQuery::Node ReferenceQuery::root(const SphereTree& tree, const SavedSpheres& saved) const {
  Node node{tree.depth(), 0, Eigen::Vector3d::Zero(), {}};
  node.ball = ball(tree, saved, node);
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
    Node& child = children.nodes[children.count++];
    child.level = node.level - 1;
    child.index = index++;
    child.cube_centre = {node.cube_centre[0] + ((k & 1) != 0 ? half : -half),
                         node.cube_centre[1] + ((k & 2) != 0 ? half : -half),
                         node.cube_centre[2] + ((k & 4) != 0 ? half : -half)};
    child.ball = ball(tree, saved, child);
  }
}

void ReferenceQuery::to_fixed_frame(Node& node) const noexcept {
  const Eigen::Vector3d& c = node.ball.centre;
  const Eigen::Matrix3d& r = pose_.rotation;
  Eigen::Vector3d moved;
  for (Eigen::Index i = 0; i < 3; ++i) {
    moved[i] = ((r(i, 0) * c[0] + r(i, 1) * c[1]) + r(i, 2) * c[2]) + pose_.translation[i];
  }
  node.ball.centre = moved;
}

bool ReferenceQuery::touch(const Ball& a, const Ball& b) noexcept {
  ++tests_;
  const double dx = a.centre[0] - b.centre[0], dy = a.centre[1] - b.centre[1],
               dz = a.centre[2] - b.centre[2];
  const double reach = (a.radius + b.radius) + slack_;
  // Rejected by >, so that what cannot be compared is kept.
  return !((dx * dx + dy * dy) + dz * dz > reach * reach);
}

void ReferenceQuery::descend(const Node& a, const Node& b) {
  if (a.level == 0 && b.level == 0) {
    found_.push_back({a.index, b.index});
    return;
  }
  const double edge_a = fixed_.lattice().edge(a.level), edge_b = moving_.lattice().edge(b.level);
  const bool open_a = a.level > 0 && (b.level == 0 || edge_b <= kLarger * edge_a);
  const bool open_b = b.level > 0 && (a.level == 0 || edge_a <= kLarger * edge_b);
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
      if (touch(of_a.nodes[i].ball, of_b.nodes[j].ball)) descend(of_a.nodes[i], of_b.nodes[j]);
    }
  }
}

}  // namespace ist
