#include "ist/query/reference/reference_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/query/query_rules.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/nested_bounds.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace detail {

// A tree, and its spheres if they are saved.
struct ReferenceBody {
  const SphereTree tree;  // shares the content
  SavedSpheres saved;     // empty with kOnTheFly
};

}  // namespace detail

namespace {

using detail::ReferenceBody;

double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// Returns whether a ball lies outside a slab; `centre` is the ball's centre, relative to the centre
// of the slab's own ball.
bool beyond(const Slab& slab, const Eigen::Vector3d& centre, double radius) noexcept {
  return std::abs(dot(slab.normal, centre) - slab.offset) > slab.half + radius;
}

// Added to sums of radii, mesh units.
struct Pads {
  double ball, fixed_slab, moving_slab;
};

struct NoSlab {};

// A node of a pair. Only kSlab carries slabs.
template <bool kSlabs>
struct ReferenceNode {
  int level;
  std::uint32_t index;
  Eigen::Vector3d cube_centre;  // in voxel edges from the root cube's centre
  Ball ball;                    // in the fixed tree's frame
  [[no_unique_address]] std::conditional_t<kSlabs, Slab, NoSlab> slab;  // in the fixed tree's frame
};

template <bool kSlabs>
struct ReferenceChildren {
  int count;
  ReferenceNode<kSlabs> nodes[8];
};

// One descent of both trees.
template <bool kSlabs>
class Descent {
  using Node = ReferenceNode<kSlabs>;
  using Children = ReferenceChildren<kSlabs>;

 public:
  Descent(const ReferenceBody& fixed, const ReferenceBody& moving, SpherePolicy policy,
          const RelativePose& pose, std::vector<LeafPair>& found)
      : fixed_(fixed), moving_(moving), policy_(policy), pose_(pose), found_(found) {
    const double radius_sum = fixed.tree.bounding_radius() + moving.tree.bounding_radius();
    const double farthest = pose.translation.cwiseAbs().maxCoeff();
    set_pads(pad_in_double(radius_sum, farthest));
    const Node a = root(fixed_);
    Node b = root(moving_);
    to_fixed_frame(b);
    // Far apart, one coordinate decides, because the square of the distance overflows.
    if (overlap(a, b) && farthest <= radius_sum + inner_.ball) descend(a, b);
  }

  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }
  // The error that a test of leaves allows for, mesh units.
  [[nodiscard]] double pad() const noexcept { return leaf_.ball; }

 private:
  // Reads the bounds of the node in child `slot` of `parent`.
  void bound(const ReferenceBody& body, std::uint32_t parent, int slot, Node& node) const {
    const TreeVoxels& voxels = voxels_of(body.tree);
    if (!body.saved.empty()) {
      node.ball = body.saved[static_cast<std::size_t>(node.level)][node.index];
    } else if (is_implicit(policy_)) {
      node.ball = voxels.ball(policy_, node.level, node.index, node.cube_centre);
    } else {
      node.ball = voxels.saved_ball(node.level, parent, slot);
    }
    if constexpr (kSlabs) node.slab = voxels.saved_slab(node.level, parent, slot);
  }

  [[nodiscard]] Node root(const ReferenceBody& body) const {
    Node node{body.tree.depth(), 0, Eigen::Vector3d::Zero(), {}, {}};
    bound(body, 0, 0, node);
    return node;
  }

  void open(const ReferenceBody& body, const Node& node, Children& children) const {
    const LinearOctree& octree = voxels_of(body.tree).octree;
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
      bound(body, node.index, slot, child);
    }
  }

  void to_fixed_frame(Node& node) const noexcept {
    const Eigen::Matrix3d& r = pose_.rotation;
    const auto turned = [&r](const Eigen::Vector3d& v) {
      return Eigen::Vector3d((r(0, 0) * v[0] + r(0, 1) * v[1]) + r(0, 2) * v[2],
                             (r(1, 0) * v[0] + r(1, 1) * v[1]) + r(1, 2) * v[2],
                             (r(2, 0) * v[0] + r(2, 1) * v[1]) + r(2, 2) * v[2]);
    };
    node.ball.centre = turned(node.ball.centre) + pose_.translation;
    if constexpr (kSlabs) node.slab.normal = turned(node.slab.normal);
  }

  // A pair of leaves that is kept may be twice the pad apart; an inner test errs by one pad more.
  void set_pads(double pad) noexcept {
    const double fixed_leaf = fixed_.tree.largest_leaf_radius(policy_),
                 moving_leaf = moving_.tree.largest_leaf_radius(policy_);
    leaf_ = {pad, pad, pad};
    inner_ = {3 * pad, 3 * pad + slab_rise(fixed_.tree.voxel_size(), moving_leaf + 2 * pad),
              3 * pad + slab_rise(moving_.tree.voxel_size(), fixed_leaf + 2 * pad)};
  }

  // Rejects by >, so that a NaN keeps the pair.
  [[nodiscard]] bool overlap(const Node& a, const Node& b) noexcept {
    ++tests_;
    const Pads& pads = a.level == 0 && b.level == 0 ? leaf_ : inner_;
    if (may_touch(a.ball, b.ball, pads.ball)) return false;
    if constexpr (kSlabs) {
      const Eigen::Vector3d apart = b.ball.centre - a.ball.centre;
      return !(beyond(a.slab, apart, b.ball.radius + pads.fixed_slab) ||
               beyond(b.slab, -apart, a.ball.radius + pads.moving_slab));
    }
    return true;
  }

  void descend(const Node& a, const Node& b) {
    if (a.level == 0 && b.level == 0) {
      found_.push_back({a.index, b.index});
      return;
    }
    const double edge_a = voxels_of(fixed_.tree).lattice.edge(a.level),
                 edge_b = voxels_of(moving_.tree).lattice.edge(b.level);
    Children of_a, of_b;
    if (descends(a.level, edge_a, b.level, edge_b)) {
      open(fixed_, a, of_a);
    } else {
      of_a.count = 1;
      of_a.nodes[0] = a;
    }
    if (descends(b.level, edge_b, a.level, edge_a)) {
      open(moving_, b, of_b);
      for (int j = 0; j < of_b.count; ++j) to_fixed_frame(of_b.nodes[j]);
    } else {
      of_b.count = 1;
      of_b.nodes[0] = b;
    }
    for (int i = 0; i < of_a.count; ++i) {
      for (int j = 0; j < of_b.count; ++j) {
        if (overlap(of_a.nodes[i], of_b.nodes[j])) descend(of_a.nodes[i], of_b.nodes[j]);
      }
    }
  }

  const ReferenceBody &fixed_, &moving_;
  const SpherePolicy policy_;
  const RelativePose pose_;
  Pads leaf_{}, inner_{};  // of pairs of leaves, and what nodes above such a pair must allow for
  std::uint64_t tests_ = 0;
  std::vector<LeafPair>& found_;
};

}  // namespace

namespace detail {

struct ReferenceState {
  ReferenceState(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 SphereSource source)
      : fixed_{fixed, {}}, moving_{moving, {}}, policy_(policy) {
    const std::string reason = contradiction(fixed, "the fixed tree", moving, "the moving tree");
    if (!reason.empty()) throw Error(ErrorCode::kArgumentInvalid, "reference query: " + reason);
    fixed.require(policy, "fixed");
    moving.require(policy, "moving");
    const ScopedFloatEnvironment environment;
    if (source == SphereSource::kSaved) {
      fixed_.saved = save_spheres(fixed, policy);
      moving_.saved = save_spheres(moving, policy);
    }
  }

  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
    const ScopedFloatEnvironment environment;
    const std::optional<RelativePose> relative =
        relative_pose(pose, parts_of(fixed_.tree).origin, parts_of(moving_.tree).origin);
    if (!relative) {
      QueryResult result;
      result.status = QueryStatus::kInvalidPose;
      result.complete = false;
      result.rotation_error = rotation_error(pose);
      return result;
    }
    QueryResult result = policy_ == SpherePolicy::kSlab ? search<true>(*relative, out)
                                                        : search<false>(*relative, out);
    result.rotation_error = rotation_error(pose);
    return result;
  }

 private:
  template <bool kSlabs>
  QueryResult search(const RelativePose& pose, std::span<LeafPair> out) {
    found_.clear();
    const Descent<kSlabs> descent(fixed_, moving_, policy_, pose, found_);
    // Pairs of one fixed leaf were found in order, because moving nodes are descended in order.
    std::stable_sort(found_.begin(), found_.end(),
                     [](const LeafPair& x, const LeafPair& y) { return x.fixed < y.fixed; });
    std::copy_n(found_.begin(), std::min(found_.size(), out.size()), out.begin());
    QueryResult result;
    result.leaf_pairs = found_.size();
    result.truncated = found_.size() > out.size();
    result.sphere_tests = descent.tests();
    result.pad = 2 * descent.pad();
    result.resolution = resolution_of(result, fixed_.tree, moving_.tree, policy_);
    return result;
  }

  ReferenceBody fixed_, moving_;
  SpherePolicy policy_;
  std::vector<LeafPair> found_;
};

}  // namespace detail

ReferenceQuery::ReferenceQuery(const SphereTree& fixed, const SphereTree& moving,
                               SpherePolicy policy, SphereSource source)
    : state_(std::make_unique<detail::ReferenceState>(fixed, moving, policy, source)) {}
ReferenceQuery::~ReferenceQuery() = default;
ReferenceQuery::ReferenceQuery(ReferenceQuery&&) noexcept = default;
ReferenceQuery& ReferenceQuery::operator=(ReferenceQuery&&) noexcept = default;

QueryResult ReferenceQuery::leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
  return state_->leaf_pairs(pose, out);
}

}  // namespace ist
