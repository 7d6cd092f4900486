#include <algorithm>

#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/query/query_state.h"

namespace ist {
namespace {

// The radius of the first search for the nearest pair, in parts of the radius that suffices, and
// the factor from one search to the next. A single search as far as the nearest pair known so far
// could find far too many pairs.
constexpr double kFirstLook = 0.125, kLookFarther = 1.25;

// The lower end at which the interval is narrow enough.
double far_enough(const DistanceInterval& distance, double tolerance) {
  return tolerance > 0 ? distance.upper - tolerance : distance.upper;
}

}  // namespace

DistanceResult Query::distance(const Eigen::Isometry3d& pose, double tolerance) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  if (!bodies) return {.status = QueryStatus::kInvalidPose};
  DistanceResult result{.distance = bodies->roots.distance, .sphere_tests = 1};
  auto& [lower, upper] = result.distance;
  const SearchPose from = s.to_float(*bodies);
  const double pad = s.pad_of(from);
  // Where the pad exceeds the leaves' radii, float cannot distinguish leaves: the roots' interval
  // stays.
  if (pad <= s.fixed.largest_leaf_radius(s.policy) + s.moving.largest_leaf_radius(s.policy)) {
    if (s.exact) {
      const DistanceInterval nearest =
          s.exact->nearest(*project_to_rigid(pose), from, pad, upper, tolerance);
      // Far from the origin the rounding error of a moved vertex can exceed the distance.
      const double off = nearest.upper > 0 ? bodies->margin : 0;
      result.distance = {std::max(lower, nearest.lower - off), nearest.upper + off};
      result.sphere_tests += s.exact->tests();
      result.complete = true;  // as far as distances of triangles are rounded
    } else {
      s.nearest_leaves(*bodies, tolerance, result);
      result.complete = upper - lower <= (tolerance > 0 ? tolerance : 0);
    }
  }
  return result;
}

void detail::QueryState::nearest_leaves(const Approach& bodies, double tolerance,
                                        DistanceResult& result) noexcept {
  auto& [lower, upper] = result.distance;
  const SearchPose plain = to_float(bodies);
  const double pad = pad_of(plain);
  Search& search = serial();
  const Dive near = search.dive(plain);
  result.sphere_tests += near.tests;
  upper = std::min(upper, near.farthest + pad);
  for (double within = std::max(lower, kFirstLook * upper);
       lower < far_enough(result.distance, tolerance); within *= kLookFarther) {
    within = std::min(within, far_enough(result.distance, tolerance));
    LeafPairSink sink(std::span<LeafPair>{});
    const Search::AnytimeResult known = search.run_within({}, to_float(bodies, within), sink);
    result.sphere_tests += known.tests;
    upper = std::min(upper, std::min(known.inner.upper, known.leaves.upper) - within + pad);
    if (sink.count() > 0) {  // the nearest leaf pair is among them
      lower = std::max(lower, within + known.leaves.min_overlapping - pad);
      break;
    }
    lower = std::max(lower, within);
  }
}

}  // namespace ist
