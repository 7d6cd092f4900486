#include "ist/query/triangles/triangle_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ist/base/float_rounding.h"
#include "ist/base/ordered_vector.h"
#include "ist/mesh/clusters/triangle_clusters.h"
#include "ist/query/traversal/budget_meter.h"
#include "ist/query/triangles/swept_visitor.h"
#include "ist/query/triangles/triangle_distance.h"
#include "ist/tree/tree_parts.h"
#include "simd/triangles/cluster_step.h"

namespace ist {
namespace {

constexpr std::size_t kBeamWidth = 6;

// Pairs of clusters that are near each other, best first, for the first bound of a distance. The
// constructor goes down both trees with the kBeamWidth best pairs of nodes of each level. There
// are no pairs if the budget ended it.
class NearestBeam {
 public:
  struct NodePair {
    std::uint32_t fixed, moving;
    float score;
  };

  NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, const ClusterPose& pose, BudgetMeter& meter) noexcept;

  [[nodiscard]] const NodePair* begin() const noexcept { return pairs_.data(); }
  [[nodiscard]] const NodePair* end() const noexcept { return pairs_.data() + count_; }

 private:
  std::array<NodePair, kBeamWidth> pairs_{};
  std::size_t count_ = 0;
};

using NodePair = NearestBeam::NodePair;

// The best pairs so far, best first; of equal ones the earlier.
struct Best {
  std::array<NodePair, kBeamWidth> pairs{};
  std::size_t count = 0;

  void add(const NodePair& pair) noexcept {
    if (count == kBeamWidth && !(pair.score < pairs[count - 1].score)) return;
    std::size_t at = count < kBeamWidth ? count++ : count - 1;
    for (; at > 0 && pair.score < pairs[at - 1].score; --at) pairs[at] = pairs[at - 1];
    pairs[at] = pair;
  }
};

// Finds the nearest pair, or one that is farther by at most the tolerance. Only nodes are left out
// for the tolerance's sake; of the triangles that are compared the nearest is found, so that the
// answer does not depend on how the kernels decide.
class NearestPair {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = true;

  NearestPair(const VisitorContext& context, double tolerance, double longest_edge,
              double nearest) noexcept
      : context_(context),
        tolerance_(tolerance > 0 ? tolerance : 0),  // a NaN too
        longest_edge_(longest_edge),
        nearest_(nearest) {}

  [[nodiscard]] double distance() const noexcept { return nearest_; }
  // Returns the pair that has the distance, the first by its indices, if any was measured.
  [[nodiscard]] const std::optional<TriangleIds>& ids() const noexcept { return ids_; }
  [[nodiscard]] double error() const noexcept {
    return nearest_ > 0 ? kTriangleDistanceError * (longest_edge_ + nearest_) : 0;
  }
  // Returns the distance from which on nothing was looked for: so that the interval is no wider
  // than the tolerance, for all rounding of its ends.
  [[nodiscard]] double within() const noexcept {
    return std::max(0.0, nearest_ * (1 + 0x1p-49) + 2 * error() - tolerance_);
  }
  [[nodiscard]] float reach() const noexcept {
    return rounded_up(within() + double{context_.step.pose.error});
  }
  bool visit(const ClusterPairs& clusters) noexcept {
    const float margin = rounded_up(2 * error() + double{context_.step.pose.error});
    Reach reaches{rounded_up(nearest_) + margin, margin};
    // Kernels list pairs in orders of their own. Of all that intersect here the first by its
    // indices counts, so the search ends after the last of them.
    const bool in_time = in_turns(
        clusters,
        [&](const ClusterPairs& rest) {
          return context_.kernels.near_clusters(context_.step, rest, reaches, context_.batch,
                                                context_.found);
        },
        [&] {
          const bool measured = measure_found();
          context_.found.open.count = 0;
          return measured;
        });
    return in_time && nearest_ > 0;
  }
  void measure(TriangleIds ids) noexcept {
    const TriangleCorners a = corners_of(context_.meshes.fixed, ids.fixed);
    const TriangleCorners b = context_.meshes.moving[ids.moving];
    const double boxes = box_distance_squared(a, b);
    const double enough = nearest_ + 2 * error();
    if (boxes > enough * enough || surely_farther(a, b, enough)) return;
    const double distance = boxes == 0 && triangles_meet(a, b)
                                ? 0
                                : std::max(std::sqrt(distance_squared(a, b)), kLeastDistance);
    if (distance > nearest_ || (distance == nearest_ && ids_ && !(ids < *ids_))) return;
    nearest_ = distance;
    ids_ = ids;
  }

 private:
  // First the pair that may be the nearest, so that few others may still be nearer. Returns false
  // where the deadline came before the end.
  bool measure_found() noexcept {
    const FoundTriangles& found = context_.found;
    const std::size_t count = found.open.count;
    const auto first = static_cast<std::size_t>(
        std::min_element(found.squares, found.squares + count) - found.squares);
    if (count > 0) measure(found.open[first]);
    std::size_t measured = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double enough = nearest_ + 2 * error() + double{context_.step.pose.error};
      if (k == first || double{found.squares[k]} > enough * enough) continue;
      if (context_.is_late(measured++)) return false;
      measure(found.open[k]);
    }
    return true;
  }

  VisitorContext context_;
  double tolerance_, longest_edge_, nearest_;
  std::optional<TriangleIds> ids_;
};

// The test of the roots, which counts.
constexpr std::uint64_t kRootTests = 1;
// The last nearest pair is a begin only where it is near: no farther than it was, by more than this
// factor and the tolerance, and no farther than a part of the bodies' radii. Else others are looked
// for first, as by a new query.
constexpr double kNearWitness = 1.25, kNearBodies = 0x1p-5;
// Pairs that are sorted fast.
constexpr std::size_t kSorted = 1 << 14;

// Returns the largest coordinate, without its sign, of a vertex in use; others may lie anywhere.
double largest_coordinate(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      largest = std::max(largest, mesh.vertices[v].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

double longest_edge(const TriangleMesh& mesh) {
  double squared = 0;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const TriangleCorners t = corners_of(mesh, k);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d edge = difference(t[i], t[(i + 1) % 3]);
      squared = std::max(squared, dot_in_order(edge, edge));
    }
  }
  return std::sqrt(squared);
}

const TriangleClusters& clusters_of(const SphereTree& tree) noexcept {
  return parts_of(tree).triangles->clusters;
}

NearestBeam::NearestBeam(const TriangleClusters& fixed, const TriangleClusters& moving,
                         const ClusterKernels& kernels, const ClusterPose& pose,
                         BudgetMeter& meter) noexcept {
  int fixed_level = fixed.root_level(), moving_level = moving.root_level();
  Best best;
  best.add({0, 0, 0});
  TurnedBlock turned;
  alignas(64) float scores[kClusterWidth];
  while (fixed_level > 0 || moving_level > 0) {
    const bool fixed_goes = fixed_level >= moving_level, moving_goes = moving_level >= fixed_level;
    Best next;
    for (std::size_t k = 0; k < best.count; ++k) {
      const NodePair pair = best.pairs[k];
      // A tree that stays has its node's siblings beside the node.
      const std::uint32_t moving_block = moving_goes ? pair.moving : pair.moving / kClusterWidth;
      const std::uint32_t fixed_block = fixed_goes ? pair.fixed : pair.fixed / kClusterWidth;
      const int below_moving = moving_level - (moving_goes ? 1 : 0);
      const int below_fixed = fixed_level - (fixed_goes ? 1 : 0);
      kernels.turn_nodes(moving.bounds(below_moving)[moving_block], pose, turned);
      for (std::uint32_t m = 0; m < moving.child_count(below_moving, moving_block); ++m) {
        const std::uint32_t moving_node = kClusterWidth * moving_block + m;
        if (!moving_goes && moving_node != pair.moving) continue;
        if (!meter.allows(kClusterWidth)) return;
        meter.spend(kClusterWidth);
        kernels.score_children(turned, m, fixed.bounds(below_fixed)[fixed_block], scores);
        for (std::uint32_t f = 0; f < fixed.child_count(below_fixed, fixed_block); ++f) {
          const std::uint32_t fixed_node = kClusterWidth * fixed_block + f;
          if (!fixed_goes && fixed_node != pair.fixed) continue;
          next.add({fixed_node, moving_node, scores[f]});
        }
      }
    }
    best = next;
    fixed_level -= fixed_goes ? 1 : 0;
    moving_level -= moving_goes ? 1 : 0;
  }
  pairs_ = best.pairs;
  count_ = best.count;
}

}  // namespace

TriangleLengths TriangleLengths::of(const SphereTree& tree) {
  const TriangleMesh* const mesh = tree.triangles();
  if (mesh == nullptr) return {};
  return {ist::largest_coordinate(*mesh), ist::longest_edge(*mesh)};
}

TriangleSearch::TriangleSearch(const SphereTree& fixed, const SphereTree& moving,
                               const Kernels& kernels, const TriangleOptions& options)
    : kernels_(kernels.clusters),
      search_(clusters_of(fixed), clusters_of(moving), kernels_, options.items),
      list_(kSorted) {
  bind(fixed, TriangleLengths::of(fixed), moving, TriangleLengths::of(moving));
  if (options.workers == 2) {
    shared_.emplace(*fixed_clusters_, *moving_clusters_, kernels_, options.period);
  }
  if (options.near_pairs > 0) {
    near_.emplace(*fixed.triangles(), *moving.triangles(), *fixed_clusters_, *moving_clusters_,
                  kernels_, options.near_pairs);
  }
}

void TriangleSearch::bind(const SphereTree& fixed, const TriangleLengths& of_fixed,
                          const SphereTree& moving, const TriangleLengths& of_moving) noexcept {
  fixed_ = &fixed;
  moving_ = &moving;
  fixed_clusters_ = &clusters_of(fixed);
  moving_clusters_ = &clusters_of(moving);
  largest_coordinate_ = of_moving.largest_coordinate;
  longest_edge_ = std::max(of_fixed.longest_edge, of_moving.longest_edge);
  search_.bind(*fixed_clusters_, *moving_clusters_);
  witnesses_ = {};
}

double TriangleSearch::moved_error(const Eigen::Isometry3d& rigid) const noexcept {
  return 0x1p-48 * (largest_coordinate_ + rigid.translation().cwiseAbs().maxCoeff());
}

bool TriangleSearch::is_too_far(const RelativePose& pose) const noexcept {
  constexpr double kFar = 0x1p12;
  return pose.translation.cwiseAbs().maxCoeff() > kFar * radii();
}

// The motion between the clusters' frames. Beside the rounding of moved vertices, that of the
// frames' origins, of the motion's product, and of coordinates in a frame.
ClusterPose TriangleSearch::cluster_pose(const TrianglePose& pose) const noexcept {
  const Eigen::Matrix3d &a = fixed_clusters_->axes(), &b = moving_clusters_->axes();
  ClusterPose out;
  Eigen::Matrix3d turned;  // rotation · b
  const auto& r = pose.relative.rotation;
  const auto product = [](const auto& row, const auto& column) {
    return (row[0] * column[0] + row[1] * column[1]) + row[2] * column[2];
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) turned(i, j) = product(r.row(i), b.col(j));
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      out.rotation[i][j] = product(a.col(i), turned.col(j));
    }
    out.translation[i] = product(a.col(i), pose.relative.translation);
  }
  out.grid = fixed_clusters_->grid();
  const double frames =
      0x1p-46 * (fixed_->bounding_radius() + moving_->bounding_radius() +
                 pose.relative.translation.cwiseAbs().maxCoeff()) +
      0x1p-50 * (fixed_->origin().cwiseAbs().maxCoeff() + moving_->origin().cwiseAbs().maxCoeff());
  out.error = rounded_up(2 * moved_error(pose.rigid) + frames);
  return out;
}

TriangleSearch::End TriangleSearch::pairs(const TrianglePose& pose, const Budget& budget,
                                          std::span<TrianglePair> out) noexcept {
  list_.begin(out);
  const Meshes meshes{*fixed_->triangles(), {*moving_->triangles(), pose.rigid}};
  search_.begin(cluster_pose(pose));
  AllPairs all({search_.step(), kernels_, meshes, memory_, budget}, list_);
  BudgetMeter meter(budget, kRootTests);
  bool complete =
      shared_ ? shared_->run(search_, meshes, meter, all, list_) : search_.run(meter, all);
  complete = all.finish() && complete;
  list_.finish();
  if (list_.count() > 0 && !out.empty()) {
    witnesses_.met = witnesses_.touching = {out[0].fixed, out[0].moving};
  }
  return {complete, meter.spent() - kRootTests};
}

TriangleSearch::Any TriangleSearch::any(const TrianglePose& pose, const Budget& budget) noexcept {
  const Meshes meshes{*fixed_->triangles(), {*moving_->triangles(), pose.rigid}};
  if (still_meet(witnesses_.met, meshes, budget)) return {{true, 1}, true};
  AnyPair any({search_.step(), kernels_, meshes, memory_, budget});
  BudgetMeter meter(budget, kRootTests);
  search_.begin(cluster_pose(pose));
  const bool complete = search_.run(meter, any);
  if (any.found()) witnesses_.met = any.found();
  return {{complete || any.found(), meter.spent() - kRootTests}, any.found().has_value()};
}

TriangleSearch::Nearest TriangleSearch::nearest(const TrianglePose& pose, double tolerance,
                                                const Budget& budget,
                                                DistanceInterval& distance) noexcept {
  const Meshes meshes{*fixed_->triangles(), {*moving_->triangles(), pose.rigid}};
  const auto closest = [&](TriangleIds ids) {
    return closest_points(corners_of(meshes.fixed, ids.fixed), meshes.moving[ids.moving],
                          {ids.fixed, ids.moving});
  };
  if (still_meet(witnesses_.touching, meshes, budget)) {
    distance = {0, 0};
    return {{true, 1}, 0, closest(*witnesses_.touching)};
  }
  search_.begin(cluster_pose(pose));
  NearestPair nearest({search_.step(), kernels_, meshes, memory_, budget}, tolerance, longest_edge_,
                      distance.upper);
  BudgetMeter meter(budget, kRootTests);
  bool near = false;
  if (witnesses_.nearest && !budget.has_tests()) {
    nearest.measure(witnesses_.nearest->ids);
    near = nearest.ids() &&
           nearest.distance() <= kNearWitness * witnesses_.nearest->distance + tolerance &&
           nearest.distance() <= kNearBodies * radii();
    meter.spend(1);
  }
  if (!near) begin_nearest(meter, nearest);
  bool complete = nearest.distance() == 0 || search_.run(meter, nearest);
  complete = complete || nearest.distance() == 0;
  if (nearest.distance() == 0) {
    witnesses_.met = witnesses_.touching = nearest.ids();
  } else if (nearest.ids()) {
    witnesses_.nearest = {*nearest.ids(), nearest.distance()};
  }
  const double error = nearest.error();
  double lower =
      nearest.distance() > 0 ? std::min(nearest.within(), nearest.distance()) - error : 0;
  if (!complete) lower = std::min(lower, search_.nearest_left());
  const double upper = nearest.ids() ? nearest.distance() + error : distance.upper;
  distance = {std::max(distance.lower, lower), std::min(distance.upper, upper)};
  std::optional<NearPair> pair;
  if (nearest.ids()) pair = closest(*nearest.ids());
  return {{complete, meter.spent() - kRootTests}, error, pair};
}

ClusterPose TriangleSearch::cluster_pose(const Eigen::Isometry3d& rigid) const noexcept {
  return cluster_pose(
      {rigid, *relative_pose(rigid, parts_of(*fixed_).origin, parts_of(*moving_).origin)});
}

TriangleSearch::Near TriangleSearch::near(const TrianglePose& pose, double enough,
                                          const Budget& budget, NearList& list) noexcept {
  const Meshes meshes{*fixed_->triangles(), {*moving_->triangles(), pose.rigid}};
  // No two points are farther apart: a float holds it.
  const double farthest = 2 * (radii() + pose.relative.translation.cwiseAbs().maxCoeff());
  enough = std::min(enough, farthest);
  const NearCache::Need need{pose.rigid, enough, distance_error(enough) + moved_error(pose.rigid)};
  const bool carries = near_ && !budget.has_tests();
  search_.begin(cluster_pose(pose));
  NearDecision decision({search_.step(), kernels_, meshes, memory_, budget}, *moving_->triangles(),
                        plain_move(pose.rigid), enough, list);
  std::uint64_t tests = 0;
  const bool kept = carries && near_->find(need);
  if (kept || (carries && near_->fill(need, budget, memory_, tests,
                                      [&](const auto& centre) { return cluster_pose(centre); }))) {
    const bool complete = near_->answer(decision, tests);
    list.finish();
    if (!budget.is_past()) prepare_near(need, 0, budget);
    return {{complete, tests}, kept};
  }
  NearbyPairs near(decision);
  BudgetMeter meter(budget, kRootTests);
  bool complete = search_.run(meter, near);
  complete = near.finish() && complete;
  list.finish();
  tests += meter.spent() - kRootTests;
  if (carries && complete && !budget.is_past()) prepare_near(need, tests, budget);
  return {{complete, tests}, false};
}

TriangleSearch::Swept TriangleSearch::swept(const RelativePose& middle, const ScrewPart& part,
                                            const Budget& budget, std::size_t most,
                                            SweptList& out) noexcept {
  const Eigen::Isometry3d at = to_isometry(part.middle);
  const Meshes meshes{*fixed_->triangles(), {*moving_->triangles(), at}};
  const Sweep sweep(part, *fixed_clusters_);
  search_.begin(cluster_pose({at, middle}), &sweep);
  SweptPairs pairs({search_.step(), kernels_, meshes, memory_, budget}, *moving_->triangles(),
                   *moving_clusters_, part, distance_error(part.speed * part.half + part.pad), most,
                   out);
  BudgetMeter meter(budget, kRootTests);
  const bool complete = search_.run(meter, pairs);
  const bool in_time = complete && pairs.finish();
  return {in_time || !pairs.fits(), pairs.fits()};
}

void TriangleSearch::prepare_near(const NearCache::Need& need, std::uint64_t tests,
                                  const Budget& budget) noexcept {
  near_->prepare(need, tests, budget, memory_,
                 [&](const Eigen::Isometry3d& centre) { return cluster_pose(centre); });
}

// Returns whether the triangles that met last still do. A limit of tests does not ask.
bool TriangleSearch::still_meet(const std::optional<TriangleIds>& witness, const Meshes& meshes,
                                const Budget& budget) noexcept {
  return witness && !budget.has_tests() && meshes.meet(*witness);
}

// Finds a first bound, as far as the budget allows.
template <class Visitor>
void TriangleSearch::begin_nearest(BudgetMeter& meter, Visitor& nearest) noexcept {
  const ClusterPose& pose = search_.step().pose;
  TurnedBlock turned;
  for (const auto& pair : NearestBeam(*fixed_clusters_, *moving_clusters_, kernels_, pose, meter)) {
    if (!meter.allows(ClusterSearch::kClusterTests)) return;
    meter.spend(ClusterSearch::kClusterTests);
    const std::uint32_t block = pair.moving / kClusterWidth, lane = pair.moving % kClusterWidth;
    kernels_.turn_nodes(moving_clusters_->bounds(0)[block], pose, turned);
    const std::uint32_t code = kClusterWidth * pair.fixed + lane;
    nearest.visit({turned, kClusterWidth * block, {&code, 1}});
  }
}

std::size_t TriangleSearch::bytes_for(const SphereTree& fixed, const SphereTree& moving,
                                      const TriangleOptions& options) noexcept {
  const TriangleClusters &of_fixed = clusters_of(fixed), &of_moving = clusters_of(moving);
  return ClusterSearch::bytes_for(of_fixed, of_moving, options.items) +
         kSorted * sizeof(TrianglePair) + FoundMemory::bytes() +
         (options.workers == 2 ? SharedPairs::bytes_for(of_fixed, of_moving) : 0) +
         (options.near_pairs > 0 ? NearCache::bytes_for(of_fixed, of_moving, options.near_pairs)
                                 : 0);
}

}  // namespace ist
