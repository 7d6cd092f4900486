#include <algorithm>

#include "ist/base/pose.h"
#include "ist/query/collision_query.h"

namespace ist {
namespace {

// How far a search for the nearest pair looks first, in parts of what is known to be far enough,
// and then each time: one search as far as the nearest pair so far could find far too much.
constexpr double kFirstLook = 0.125, kLookFarther = 1.25;

// The end of an interval whose lower end need not be raised farther.
double far_enough(const GapInterval& gap, double tolerance) {
  return tolerance > 0 ? gap.upper - tolerance : gap.upper;
}

}  // namespace

GapResult CollisionQuery::gap(const Eigen::Isometry3d& pose, double tolerance) noexcept {
  const ScopedFloatEnvironment environment;
  const std::optional<Approach> bodies = approach(pose, triangle_error(pose));
  if (!bodies) return {QueryStatus::kInvalidPose, {}, 0};
  GapResult result{QueryStatus::kDone, bodies->roots.gap, 1};
  if (pad_of(narrowed(*bodies)) >
      fixed_.largest_leaf_radius(policy_) + moving_.largest_leaf_radius(policy_)) {
    return result;
  }
  if (exact_) {
    const SearchPose from = narrowed(*bodies);
    const GapInterval nearest =
        exact_->nearest(*project_to_rigid(pose), from, pad_of(from), result.gap.upper, tolerance);
    // Far from the origin a vertex moved in double can be off by more than a distance is.
    const double off = nearest.upper > 0 ? bodies->grow : 0;
    result.gap = {std::max(result.gap.lower, nearest.lower - off), nearest.upper + off};
    result.sphere_tests += exact_->tests();
  } else {
    nearest_leaves(*bodies, tolerance, result);
  }
  return result;
}

void CollisionQuery::nearest_leaves(const Approach& bodies, double tolerance,
                                    GapResult& result) noexcept {
  auto& [lower, upper] = result.gap;
  const SearchPose plain = narrowed(bodies);
  const double pad = pad_of(plain);
  Search& search = alone();
  const Dive near = search.dive(plain);
  result.sphere_tests += near.tests;
  upper = std::min(upper, near.farthest + pad);
  for (double within = std::max(lower, kFirstLook * upper);
       lower < far_enough(result.gap, tolerance); within *= kLookFarther) {
    within = std::min(within, far_enough(result.gap, tolerance));
    ContactSink sink(std::span<Contact>{});
    const Search::Known known = search.run_within({}, narrowed(bodies, within), sink);
    result.sphere_tests += known.tests;
    upper = std::min(upper, std::min(known.inner.farthest, known.leaves.farthest) - within + pad);
    if (sink.count() > 0) {  // the nearest leaves are among them
      lower = std::max(lower, within + known.leaves.touching - pad);
      break;
    }
    lower = std::max(lower, within);
  }
}

}  // namespace ist
