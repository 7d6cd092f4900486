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
  NearestLeaves(const SearchPose& plain, double tolerance, const BudgetMeter& meter,
                DistanceInterval& distance) noexcept
      : plain_(plain),
        tolerance_(tolerance > 0 ? tolerance : 0),
        meter_(meter),
        distance_(distance) {}

  Advanced advance(const SearchBatch& batch) noexcept {
    // Enough: where the interval is narrow, nothing farther than its upper end is looked for.
    const double within = std::max(0.0, distance_.upper - tolerance_);
    DistanceBounds bounds{static_cast<float>(least_ - within),
                          static_cast<float>(distance_.upper + within)};
    const DistanceBounds before = bounds;
    const Advanced made =
        batch.measure(Measured::kBoth, inflated(plain_, within), bounds, meter_.allow());
    if (bounds.lower < before.lower) least_ = std::min(least_, bounds.lower + within);
    if (bounds.upper < before.upper) {
      distance_.upper = std::min(distance_.upper, std::max(0.0, bounds.upper - within));
    }
    meter_.spend(made.tests);
    return made;
  }
  static bool leaves(const Frontier& /*pairs*/) noexcept { return true; }
  static std::size_t most_groups() noexcept { return kGroups; }

  /// Returns a lower bound of the distance, once the search came to its end.
  [[nodiscard]] double least() const noexcept { return least_; }
  [[nodiscard]] std::uint64_t tests() const noexcept { return meter_.spent(); }

 private:
  // The batch size, in fixed nodes: the sooner leaves are reached, the sooner the search narrows.
  static constexpr std::size_t kGroups = 16;

  const SearchPose& plain_;
  double tolerance_;
  BudgetMeter meter_;
  DistanceInterval& distance_;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

DistanceResult Query::distance(const Eigen::Isometry3d& pose, double tolerance,
                               const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  const double off = rotation_error(pose);
  if (!bodies) return {.status = QueryStatus::kInvalidPose, .rotation_error = off};
  DistanceResult result{
      .distance = bodies->roots.distance, .sphere_tests = 1, .rotation_error = off};
  if (s.triangles) {
    s.nearest_triangles(pose, *bodies, tolerance, budget, result);
  } else {
    s.nearest_leaves(*bodies, tolerance, budget, result);
  }
  const auto& [lower, upper] = result.distance;
  result.complete = upper - lower <= (tolerance > 0 ? tolerance : 0);
  return result;
}

void detail::QueryState::nearest_triangles(const Eigen::Isometry3d& pose, const Approach& bodies,
                                           double tolerance, const Budget& budget,
                                           DistanceResult& result) noexcept {
  auto& [lower, upper] = result.distance;
  // Far from the origin the rounding error of a moved vertex can exceed the distance.
  const double off = bodies.margin;
  if (triangles->is_too_far(bodies.relative)) {
    result.narrowest = upper - lower;
    return;
  }
  DistanceInterval nearest{0, upper};
  const TriangleSearch::Nearest end = triangles->nearest({*project_to_rigid(pose), bodies.relative},
                                                         tolerance - 2 * off, budget, nearest);
  const bool apart = nearest.upper > 0;
  result.distance = {apart ? std::max(lower, nearest.lower - off) : 0,
                     apart ? std::min(upper, nearest.upper + off) : 0};
  result.narrowest = apart ? 2 * (end.error + off) : 0;
  result.sphere_tests += end.tests;
}

void detail::QueryState::nearest_leaves(const Approach& bodies, double tolerance,
                                        const Budget& budget, DistanceResult& result) noexcept {
  auto& [lower, upper] = result.distance;
  const SearchPose plain = to_float(bodies);
  QueryResult leaves;
  set_pad(2 * pad_of(plain), leaves);
  result.narrowest = 2 * leaves.resolution;
  // Where the pad exceeds the leaves' radii, float cannot distinguish leaves: the roots' interval
  // stays.
  if (pad_of(plain) > fixed.largest_leaf_radius(policy) + moving.largest_leaf_radius(policy)) {
    result.narrowest = std::max(result.narrowest, upper - lower);
    return;
  }
  BudgetMeter meter(budget, budget.has_tests() ? result.sphere_tests : 0);
  const std::uint64_t before = meter.spent();
  upper = std::min(upper, double{serial().beam(plain, meter)});
  NearestLeaves nearest(plain, tolerance, meter, result.distance);
  const bool whole = serial().run(nearest) == plan.steps().size();
  result.sphere_tests += nearest.tests() - before;
  if (whole) lower = std::min(upper, std::max(lower, nearest.least()));
}

}  // namespace ist
