#include "ist/query/query.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <utility>

#include "ist/base/access.h"
#include "ist/base/float_environment.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query_state.h"
#include "ist/query/traversal/budget_meter.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/query/workers/shared_work.h"

namespace ist {
namespace {

// Batch size, in fixed nodes, of a search that ends at its first leaf pair.
constexpr std::size_t kFewGroups = 16;

std::atomic<detail::ReadClock> budget_clock{&Budget::Clock::now};

// Ends at the first leaf pair.
class AnyLeafPair : public MeteredVisitor {
 public:
  AnyLeafPair(const SearchPose& pose, const BudgetMeter& meter) noexcept
      : MeteredVisitor(pose, meter, Measured::kNothing) {}

  [[nodiscard]] bool found() const noexcept { return found_; }
  Advanced advance(const SearchBatch& batch) noexcept {
    const Advanced made = batch.advance(pose_, meter_.allow());
    meter_.spend(made.tests);
    return made;
  }
  bool leaves(const Frontier& pairs) noexcept {
    found_ = pairs.moving_count > 0;
    return !found_;
  }
  static std::size_t most_groups() noexcept { return kFewGroups; }

 private:
  bool found_ = false;
};

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

Budget::Clock::time_point detail::budget_now() noexcept {
  return budget_clock.load(std::memory_order_relaxed)();
}
detail::ReadClock detail::set_budget_clock(ReadClock clock) noexcept {
  return budget_clock.exchange(clock, std::memory_order_relaxed);
}

const char* to_string(Answer answer) noexcept {
  constexpr std::array kNames = {"unknown", "no", "near", "yes"};
  const auto at = static_cast<std::size_t>(answer);
  return at < kNames.size() ? kNames[at] : kNames[0];
}

const char* to_string(QueryStatus status) noexcept {
  constexpr std::array kNames = {
      "done",         "invalid-pose", "no-triangles",   "manifold-mismatch", "busy",
      "not-prepared", "no-such-body", "margin-invalid", "no-such-triangle",  "no-voxels"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

// The constructor must not depend on the caller's floating-point environment either.
Query::Query(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options)
    : state_(
          std::make_unique<detail::QueryState>(fixed, moving, options, ScopedFloatEnvironment())) {}
Query::Query(std::unique_ptr<detail::QueryState> state) noexcept : state_(std::move(state)) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

IntersectionResult Query::intersects(const Eigen::Isometry3d& pose, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  const double off = rotation_error(pose);
  if (!bodies) return {.status = QueryStatus::kInvalidPose, .rotation_error = off};
  IntersectionResult result{
      .answer = Answer::kNo, .complete = true, .sphere_tests = 1, .rotation_error = off};
  if (!bodies->roots.overlap) return result;
  if (s.triangles) {
    const TriangleSearch::Any any =
        s.triangles->any({*project_to_rigid(pose), bodies->relative}, budget);
    result.sphere_tests += any.tests;
    result.complete = any.complete;
    result.answer = any.found ? Answer::kYes : any.complete ? Answer::kNo : Answer::kUnknown;
    return result;
  }
  const SearchPose from = s.to_float(*bodies);
  const BudgetMeter meter(budget, budget.has_tests() ? result.sphere_tests : 0);
  AnyLeafPair any(from, meter);
  const bool whole = s.serial().run(any) == s.plan->steps().size();
  result.sphere_tests += any.tests() - meter.spent();
  result.complete = whole || any.found();
  if (any.found()) {
    QueryResult of_pairs;
    s.set_pad(2 * s.pad_of(from), of_pairs);
    result.resolution = of_pairs.resolution;
    result.answer = Answer::kNear;
  } else if (!whole) {
    result.answer = Answer::kUnknown;
  }
  return result;
}

QueryResult Query::leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out,
                              const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (!s.has_leaves()) return {.status = QueryStatus::kNoVoxels, .complete = false};
  LeafPairSink sink(*s.plan, s.kernels, out);
  return s.list(pose, budget, sink);
}

QueryResult Query::leaf_pairs(const Eigen::Isometry3d& pose, LeafPairStream& stream) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (!s.has_leaves()) return {.status = QueryStatus::kNoVoxels, .complete = false};
  LeafPairSink sink(*s.plan, s.kernels, s.window, stream);
  return s.list(pose, {}, sink);
}

QueryResult Query::contacts(const Eigen::Isometry3d& pose, ContactManifold& manifold,
                            const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  detail::ContactReducer& reducer = detail::reducer_of(manifold);
  reducer.clear();
  if (!s.has_leaves()) return {.status = QueryStatus::kNoVoxels, .complete = false};
  if (!reducer.fits(s.fixed, s.moving, s.policy)) {
    return {.status = QueryStatus::kManifoldMismatch, .complete = false};
  }
  const double reach = reducer.scale().reach;
  const std::optional<detail::Approach> bodies = s.approach(pose, reach);
  if (!bodies) return detail::invalid_pose(pose);
  QueryResult result = s.root_result(bodies->roots, reach);
  result.rotation_error = rotation_error(pose);
  if (!bodies->roots.overlap) return result;

  const SearchPose from = s.to_float(*bodies);
  ContactOutput sink(*s.plan, s.kernels, from, reducer.adder(), reducer.leaf_sums());
  // Only the end of a budget needs a bound: the upper one, because pairs of nodes are left.
  const Measured measured = budget.is_limited() ? Measured::kUpper : Measured::kNothing;
  auto [lower, upper] = s.search<ContactVisitor>(*bodies, from, budget, measured, sink, result);
  sink.flush();
  if (result.leaf_pairs > 0) upper = std::min(upper, result.resolution);
  if (result.complete && result.leaf_pairs == 0) lower = std::max(lower, reach);
  result.distance = {lower, upper};
  reducer.finish(bodies->relative, result.complete);
  return result;
}

TrianglePairsResult Query::triangle_pairs(const Eigen::Isometry3d& pose,
                                          std::span<TrianglePair> out,
                                          const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (!s.triangles) return {.status = QueryStatus::kNoTriangles, .complete = false};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  const double off = rotation_error(pose);
  if (!bodies) {
    return {.status = QueryStatus::kInvalidPose, .complete = false, .rotation_error = off};
  }
  TrianglePairsResult result{.sphere_tests = 1, .rotation_error = off};
  if (!bodies->roots.overlap) return result;
  const TriangleSearch::End end =
      s.triangles->pairs({*project_to_rigid(pose), bodies->relative}, budget, out);
  result.sphere_tests += end.tests;
  result.complete = end.complete;
  result.triangle_pairs = s.triangles->pair_count();
  result.truncated = result.triangle_pairs > out.size();
  return result;
}

NearPairsResult Query::near_pairs(const Eigen::Isometry3d& pose, double margin,
                                  std::span<NearPair> out, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (!s.triangles) return {.status = QueryStatus::kNoTriangles, .complete = false};
  if (!detail::is_margin(margin)) return {.status = QueryStatus::kMarginInvalid, .complete = false};
  const double error = s.triangles->distance_error(margin) + s.triangle_error(pose);
  const std::optional<detail::Approach> bodies = s.approach(pose, margin + 2 * error);
  const double off = rotation_error(pose);
  if (!bodies) {
    return {.status = QueryStatus::kInvalidPose, .complete = false, .rotation_error = off};
  }
  NearPairsResult result{.pad = 2 * error, .sphere_tests = 1, .rotation_error = off};
  if (!bodies->roots.overlap) {
    result.found = Found::kClear;
    return result;
  }
  if (s.triangles->is_too_far(bodies->relative)) {
    result.complete = false;
    return result;
  }
  NearList list;
  list.begin(out);
  const TriangleSearch::Near end =
      s.triangles->near({*project_to_rigid(pose), bodies->relative}, margin + error, budget, list);
  result.sphere_tests += end.tests;
  result.complete = end.complete;
  result.found = end.kept ? Found::kKept : Found::kFresh;
  result.near_pairs = list.count();
  result.truncated = result.near_pairs > out.size();
  return result;
}

NearPairsResult Query::near_parts(const Eigen::Isometry3d& pose, TrianglePair triangles,
                                  double margin, std::span<NearPair, kMostNearParts> out) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (!s.triangles) return {.status = QueryStatus::kNoTriangles, .complete = false};
  if (!detail::is_margin(margin)) return {.status = QueryStatus::kMarginInvalid, .complete = false};
  const TriangleMesh &fixed = *s.fixed.triangles(), &moving = *s.moving.triangles();
  if (triangles.fixed >= fixed.triangles.size() || triangles.moving >= moving.triangles.size()) {
    return {.status = QueryStatus::kNoSuchTriangle, .complete = false};
  }
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  const double off = rotation_error(pose);
  if (!rigid) {
    return {.status = QueryStatus::kInvalidPose, .complete = false, .rotation_error = off};
  }
  const double error = s.triangles->distance_error(margin) + s.triangle_error(pose);
  NearPairsResult result{.pad = 2 * error, .rotation_error = off};
  result.near_pairs = ist::near_parts(corners_of(fixed, triangles.fixed),
                                      MovedTriangles(moving, *rigid)[triangles.moving], triangles,
                                      margin + error, out);
  return result;
}

void Query::forget() noexcept {
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return;
  if (s.triangles) s.triangles->forget();
  if (s.cached) s.cached->forget();
}

bool Query::has_triangles() const noexcept { return state_->triangles != nullptr; }
const SphereTree& Query::fixed() const noexcept { return state_->fixed; }
const SphereTree& Query::moving() const noexcept { return state_->moving; }
SpherePolicy Query::policy() const noexcept { return state_->policy; }
const char* Query::target() const noexcept { return state_->kernels.target; }
std::size_t Query::bytes() const noexcept { return state_->bytes; }
int Query::workers() const noexcept { return state_->workers; }

Sharing sharing_of(const Query& query) noexcept {
  const detail::QueryState& s = detail::Access::state(query);
  const auto* shared = std::get_if<SharedSearch>(&s.searches);
  Sharing sum = shared != nullptr ? shared->sharing() : Sharing{};
  if (s.triangles) sum += s.triangles->sharing();
  return sum;
}

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
  result.nearest = end.pair;
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
  const bool whole = serial().run(nearest) == plan->steps().size();
  result.sphere_tests += nearest.tests() - before;
  if (whole) lower = std::min(upper, std::max(lower, nearest.least()));
}

}  // namespace ist
