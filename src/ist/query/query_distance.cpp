#include <algorithm>
#include <limits>

#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/query/query_state.h"
#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// Bounds the distance by every pair that it tests, and leaves out those so far apart that they
// cannot narrow the interval to `tolerance`.
class NearestLeaves : public VisitorBase {
 public:
  NearestLeaves(const SearchPose& plain, double tolerance, DistanceInterval& distance) noexcept
      : plain_(plain), tolerance_(tolerance > 0 ? tolerance : 0), distance_(distance) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    // Enough: where the interval is narrow, nothing farther than its upper end is looked for.
    const double within = std::max(0.0, distance_.upper - tolerance_);
    DistanceBounds bounds{static_cast<float>(least_ - within),
                          static_cast<float>(distance_.upper + within)};
    const DistanceBounds before = bounds;
    const Advanced made = batch.measure(Measured::kBoth, inflated(plain_, within), bounds);
    if (bounds.lower < before.lower) least_ = std::min(least_, bounds.lower + within);
    if (bounds.upper < before.upper) {
      distance_.upper = std::min(distance_.upper, std::max(0.0, bounds.upper - within));
    }
    tests_ += made.tests;
    return made;
  }
  static bool leaves(const Frontier& /*pairs*/) noexcept { return true; }
  static std::size_t most_groups() noexcept { return kGroups; }

  /// Returns a lower bound of the distance, once the search is over.
  [[nodiscard]] double least() const noexcept { return least_; }
  [[nodiscard]] std::uint64_t tests() const noexcept { return tests_; }

 private:
  // The batch size, in fixed nodes: the sooner leaves are reached, the sooner the search narrows.
  static constexpr std::size_t kGroups = 16;

  const SearchPose& plain_;
  double tolerance_;
  DistanceInterval& distance_;
  double least_ = std::numeric_limits<double>::infinity();
  std::uint64_t tests_ = 0;
};

}  // namespace

DistanceResult Query::distance(const Eigen::Isometry3d& pose, double tolerance) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  if (!bodies) return {.status = QueryStatus::kInvalidPose};
  DistanceResult result{.distance = bodies->roots.distance, .sphere_tests = 1};
  auto& [lower, upper] = result.distance;
  if (s.exact) {
    if (s.exact->is_too_far(bodies->relative)) return result;
    DistanceInterval nearest{0, upper};
    const ExactSearch::End end =
        s.exact->nearest({*project_to_rigid(pose), bodies->relative}, tolerance, {}, nearest);
    // Far from the origin the rounding error of a moved vertex can exceed the distance.
    const double off = nearest.upper > 0 ? bodies->margin : 0;
    result.distance = {std::max(lower, nearest.lower - off), nearest.upper + off};
    result.sphere_tests += end.tests;
    result.complete = true;  // as far as distances of triangles are rounded
    return result;
  }
  // Where the pad exceeds the leaves' radii, float cannot distinguish leaves: the roots' interval
  // stays.
  const double pad = s.pad_of(s.to_float(*bodies));
  if (pad <= s.fixed.largest_leaf_radius(s.policy) + s.moving.largest_leaf_radius(s.policy)) {
    s.nearest_leaves(*bodies, tolerance, result);
    result.complete = upper - lower <= (tolerance > 0 ? tolerance : 0);
  }
  return result;
}

void detail::QueryState::nearest_leaves(const Approach& bodies, double tolerance,
                                        DistanceResult& result) noexcept {
  auto& [lower, upper] = result.distance;
  const SearchPose plain = to_float(bodies);
  const Search::Beam near = serial().beam(plain);
  upper = std::min(upper, double{near.bounds.upper});
  NearestLeaves nearest(plain, tolerance, result.distance);
  serial().run(nearest);
  result.sphere_tests += near.tests + nearest.tests();
  lower = std::min(upper, std::max(lower, nearest.least()));
}

}  // namespace ist
