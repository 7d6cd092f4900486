// The interval that a stopped search tells, against the formula of docs/guarantees.md, computed in
// double, by nothing of the kernels, from the list of all pairs that are pruned or live where the
// search stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/traversal/search.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/scenes.h"
#include "support/rigid_pose.h"

namespace ist::test {
namespace {

// A node's bound in its tree's frame, mesh units, as the tree holds it. The slab of kSlab alone.
struct Bound {
  Ball ball;
  Slab slab;
};

Bound bound_of(const SphereTree& tree, SpherePolicy policy, int level, std::uint32_t parent,
               int slot) {
  const TreeVoxels& voxels = voxels_of(tree);
  if (policy == SpherePolicy::kSlab) {
    return {voxels.saved_ball(level, parent, slot), voxels.saved_slab(level, parent, slot)};
  }
  if (policy == SpherePolicy::kTight) return {voxels.saved_ball(level, parent, slot), {}};
  const OctreeNode& above = voxels.octree.nodes(level + 1)[parent];
  Eigen::Vector3d centre(above.centre[0], above.centre[1], above.centre[2]);
  if (level < tree.depth()) {  // the root has the centre of its parent
    unsigned octants = voxels.octree.mask(level + 1, parent);
    for (int i = 0; i < slot; ++i) octants &= octants - 1;
    const unsigned octant = static_cast<unsigned>(std::countr_zero(octants));
    for (unsigned axis = 0; axis < 3; ++axis) {
      centre[axis] += std::ldexp((octant >> axis & 1) != 0 ? 0.5 : -0.5, level);
    }
  }
  const std::uint32_t node = above.first_child + static_cast<std::uint32_t>(slot);
  return {voxels.nested_ball(policy, level, node, centre), {}};
}

// The level of the nodes that a side of a step reads.
int level_of(const SphereTree& tree, const SearchSide& side) {
  int level = tree.depth() + 1;
  while (level > 1 && voxels_of(tree).octree.nodes(level).data() != side.nodes) --level;
  return level;
}

// The bounds that a step tests of a frontier's node: of its children, or its own.
std::vector<Bound> bounds_of(const SphereTree& tree, SpherePolicy policy, const SearchSide& side,
                             std::uint32_t node) {
  const int level = level_of(tree, side);
  if (!side.descends) {
    return {bound_of(tree, policy, level - 1, node / 8, static_cast<int>(node % 8))};
  }
  std::vector<Bound> bounds;
  for (int slot = 0; slot < voxels_of(tree).octree.child_count(level, node); ++slot) {
    bounds.push_back(bound_of(tree, policy, level - 1, node, slot));
  }
  return bounds;
}

// The distances that the bounds of a pair allow, mesh units, without the pads for rounding, but
// slabs of inner nodes count as wider for large partners; and whether they overlap, within all
// pads.
struct Distances {
  double least, greatest;
  bool overlap;
};

Distances distances_of(const Bound& fixed, const Bound& moving, const RelativePose& pose,
                       const Pads& pads, const Pads& rounding, bool slabs) {
  const Eigen::Vector3d between =
      pose.rotation * moving.ball.centre + pose.translation - fixed.ball.centre;
  const double distance = between.norm(), radii = fixed.ball.radius + moving.ball.radius;
  Distances distances{distance - radii, distance + radii, distance - radii <= double{pads.ball}};
  if (!slabs) return distances;
  // How far a partner's ball is beyond a slab; `between` leads from the slab's ball to it.
  const auto beyond = [](const Slab& slab, const Eigen::Vector3d& between, double radius) {
    return std::abs(slab.normal.dot(between) - slab.offset) - slab.half - radius;
  };
  const double of_fixed = beyond(fixed.slab, between, moving.ball.radius);
  const double of_moving =
      beyond(moving.slab, -(pose.rotation.transpose() * between), fixed.ball.radius);
  const auto rise = [](float pad, float of_rounding) { return double{pad} - double{of_rounding}; };
  distances.overlap = distances.overlap && of_fixed <= double{pads.slab_fixed} &&
                      of_moving <= double{pads.slab_moving};
  distances.least =
      std::max({distances.least, of_fixed - rise(pads.slab_fixed, rounding.slab_fixed),
                of_moving - rise(pads.slab_moving, rounding.slab_moving)});
  return distances;
}

// The pads of inner nodes without a slab's rise: in proportion to those of leaves, as derived.
Pads rounding_of(const SearchPose& pose) {
  const float slab = pose.leaf.slab_fixed * (53.0F / 17);
  return {pose.inner.ball, slab, slab};
}

// Two trees at a pose, whose bounds are read as the policy says.
struct Bodies {
  const SphereTree &fixed, &moving;
  SpherePolicy policy;
  RelativePose at;
};

// Lists pairs, and keeps its own list of all pairs that are pruned, and of those that are live: an
// overlapping pair is live until all its children are tested. Distances are computed in double from
// the content of the trees, and so is whether a pair overlaps.
class Listing : public PairLister {
 public:
  Listing(const Bodies& bodies, const SearchPose& pose, LeafPairSink& sink,
          const BudgetMeter& meter)
      : PairLister(pose, sink, meter, Measured::kBoth),
        bodies_(bodies),
        pose_(pose),
        inner_(rounding_of(pose)) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    SearchCursor from = batch.cursor;
    const Advanced made = PairLister::advance(batch);
    const SearchStep& step = batch.step;
    const bool slabs = bodies_.policy == SpherePolicy::kSlab;
    std::uint64_t tests = 0;
    for (; tests < made.tests; ++from.group, from.row = from.moving = 0) {
      const SearchGroup group = batch.in.groups[from.group];
      const std::uint32_t begin = from.group == 0 ? 0 : batch.in.groups[from.group - 1].end;
      const std::vector<Bound> rows =
          bounds_of(bodies_.fixed, bodies_.policy, step.fixed, group.fixed);
      for (; from.row < rows.size() && tests < made.tests; ++from.row, from.moving = 0) {
        for (std::uint32_t i = begin + from.moving; i < group.end && tests < made.tests; ++i) {
          for (const Bound& moving :
               bounds_of(bodies_.moving, bodies_.policy, step.moving, batch.in.moving[i])) {
            const Distances distances =
                distances_of(rows[from.row], moving, bodies_.at, pads_of(pose_, step),
                             step.leaves ? pose_.leaf : inner_, slabs);
            (distances.overlap ? live_ : pruned_).push_back(distances);
            ++tests;
          }
        }
      }
    }
    EXPECT_EQ(tests, made.tests);
    return made;
  }

  // With a step that is whole, the pairs before it are live no more.
  bool enter(std::size_t /*step*/, const Frontier& pairs, bool whole) noexcept {
    EXPECT_TRUE(whole);
    end_step(pairs.moving_count);
    return true;
  }
  // The search found that `pairs` pairs of the step overlap.
  void end_step(std::size_t pairs) {
    live_.erase(live_.begin(), live_.begin() + static_cast<std::ptrdiff_t>(before_));
    before_ = live_.size();
    EXPECT_EQ(before_, pairs);
  }

  [[nodiscard]] DistanceInterval formula(double pad) const {
    DistanceInterval interval{HUGE_VAL, HUGE_VAL};
    for (const auto* pairs : {&live_, &pruned_}) {
      for (const Distances& d : *pairs) interval.lower = std::min(interval.lower, d.least);
    }
    for (const Distances& d : live_.empty() ? pruned_ : live_) {
      interval.upper = std::min(interval.upper, d.greatest);
    }
    return {std::max(0.0, interval.lower - pad), interval.upper + pad};
  }

 private:
  const Bodies& bodies_;
  const SearchPose& pose_;
  Pads inner_;
  std::vector<Distances> live_{{-HUGE_VAL, HUGE_VAL, true}};  // first the pair of roots
  std::size_t before_ = 1;                                    // live before the step
  std::vector<Distances> pruned_;
};

TEST(StoppedSearch, TellsNoWiderIntervalThanTheFormula) {
  int stopped = 0, apart = 0;
  for (const Scene& scene : solids()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      const SearchPlan plan(scene.fixed, scene.moving, policy);
      const Kernels& kernels = select_kernels("");
      Search search(plan, kernels, 1 << 20);
      Query query(scene.fixed, scene.moving, options_of(policy));
      ContactManifold contacts(scene.fixed, scene.moving, policy, {.margin = 2});
      for (const double x : {0.0, 1.6, 1.9, 2.1, 2.6}) {
        Eigen::Isometry3d at = scene.pose;
        at.translation()[0] += x;
        for (const std::uint64_t tests : {1u, 9u, 100u, 900u, 7'000u, 40'000u, 10'000'000u}) {
          SCOPED_TRACE(scene.name + ", " + std::string(to_string(policy)) + ", " +
                       std::to_string(x) + ", " + std::to_string(tests) + " tests");
          const QueryResult told =
              query.leaf_pairs(at, std::span<LeafPair>(), {.tests = tests + 1});
          if (told.sphere_tests == 1) continue;  // the roots are apart, or no test was left
          const Eigen::Isometry3d between = between_frames(at, scene.fixed, scene.moving);
          const Bodies bodies{scene.fixed, scene.moving, policy,
                              RelativePose{between.linear(), between.translation()}};
          const SearchPose pose = to_float(bodies.at, lengths_of(scene.fixed, policy),
                                           lengths_of(scene.moving, policy));
          LeafPairSink sink(plan, kernels, {});
          Listing listing(bodies, pose, sink, BudgetMeter({.tests = tests}));
          const std::size_t steps = search.run(listing);
          if (steps == plan.steps().size()) listing.end_step(sink.count());
          EXPECT_EQ(listing.tests() + 1, told.sphere_tests);
          EXPECT_EQ(static_cast<int>(plan.steps().size() - steps), told.level);
          EXPECT_EQ(told.complete, told.level == 0);
          const Pads pads = rounding_of(pose);  // no less than those of leaves
          const DistanceInterval formula =
              listing.formula(std::max({pads.ball, pads.slab_fixed, pads.slab_moving}));
          const double last_bits = 1e-6 * formula.upper;
          EXPECT_GE(told.distance->lower, formula.lower - last_bits);
          EXPECT_LE(told.distance->upper, formula.upper + last_bits);
          const QueryResult weighed = query.contacts(at, contacts, {.tests = tests + 1});
          EXPECT_EQ(weighed.sphere_tests, told.sphere_tests);
          EXPECT_EQ(weighed.level, told.level);
          if (!weighed.complete) {
            EXPECT_GE(weighed.distance->lower, formula.lower - last_bits);
            EXPECT_LE(weighed.distance->upper, formula.upper + last_bits);
          }
          stopped += told.complete ? 0 : 1;
          apart += formula.lower > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(apart, 10);
}

}  // namespace
}  // namespace ist::test
