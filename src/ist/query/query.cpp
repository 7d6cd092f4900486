#include "ist/query/query.h"

#include <algorithm>
#include <array>

#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query_state.h"

namespace ist {
namespace {

// Batch size, in fixed nodes, of a search that ends at its first leaf pair.
constexpr std::size_t kFewGroups = 16;

// The budget that is left after the root test.
Budget minus_root_test(Budget budget) {
  budget.tests -= budget.has_tests() && budget.tests > 0 ? 1U : 0U;
  return budget;
}

}  // namespace

const char* to_string(QueryStatus status) noexcept {
  constexpr std::array kNames = {"done", "invalid-pose", "no-triangles", "manifold-mismatch"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

// The constructor must not depend on the caller's floating-point environment either.
Query::Query(const SphereTree& fixed, const SphereTree& moving, const QueryOptions& options)
    : state_(
          std::make_unique<detail::QueryState>(fixed, moving, options, ScopedFloatEnvironment())) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

IntersectionResult Query::intersects(const Eigen::Isometry3d& pose) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  if (!bodies) return {.status = QueryStatus::kInvalidPose};
  IntersectionResult result;
  if (!bodies->roots.overlap) return result;
  const SearchPose from = s.to_float(*bodies);
  if (s.exact) {
    if (s.exact->any(*project_to_rigid(pose), from)) result.answer = Answer::kYes;
    return result;
  }
  struct First final : LeafPairStream {
    bool take(std::span<const LeafPair>) noexcept override { return false; }
  } first;
  LeafPairSink sink(s.window, first);
  static_cast<void>(s.serial().run_hurried(from, sink, kFewGroups));
  if (sink.count() > 0) {
    QueryResult of_pairs;
    s.set_pad(2 * s.pad_of(from), of_pairs);
    result.answer = Answer::kNear;
    result.resolution = of_pairs.resolution;
  }
  return result;
}

QueryResult Query::leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out,
                              const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  LeafPairSink sink(out);
  if (!budget.has_tests() && !budget.has_deadline()) return s.search(pose, sink);
  const std::optional<detail::Approach> bodies = s.approach(pose);
  if (!bodies) return {.status = QueryStatus::kInvalidPose, .complete = false};
  QueryResult result = s.root_result(bodies->roots);
  result.distance = bodies->roots.distance;
  if (!bodies->roots.overlap) return result;

  const SearchPose from = s.to_float(*bodies);
  const double pad = s.pad_of(from);
  s.set_pad(2 * pad, result);
  const Search::AnytimeResult known = s.serial().run_within(minus_root_test(budget), from, sink);
  s.set_steps(known.steps, result);
  result.sphere_tests += known.tests;
  result.leaf_pairs = sink.count();
  result.truncated = sink.truncated();
  // Surfaces in a pair of nodes that was not descended may intersect.
  const double apart = result.complete && result.leaf_pairs == 0
                           ? std::min(known.inner.min_pruned, known.leaves.min_pruned)
                           : 0;
  const double upper = std::min(known.inner.upper, known.leaves.upper);
  result.distance->lower = std::max(result.distance->lower, apart - pad);
  result.distance->upper = std::min(result.distance->upper, upper + pad);
  return result;
}

QueryResult Query::leaf_pairs(const Eigen::Isometry3d& pose, LeafPairStream& stream) noexcept {
  const ScopedFloatEnvironment environment;
  LeafPairSink sink(state_->window, stream);
  return state_->search(pose, sink);
}

QueryResult Query::contacts(const Eigen::Isometry3d& pose, ContactManifold& manifold,
                            const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  detail::ContactReducer& reducer = manifold.reducer();
  const bool rigid = reducer.begin(pose);  // empties the reducer in any case
  if (!reducer.fits(s.fixed, s.moving, s.policy)) {
    return {.status = QueryStatus::kManifoldMismatch, .complete = false};
  }
  const double margin = reducer.scale().margin;
  const std::optional<detail::Approach> bodies = s.approach(pose, margin);
  if (!rigid || !bodies) return {.status = QueryStatus::kInvalidPose, .complete = false};
  QueryResult result = s.root_result(bodies->roots);
  result.distance = bodies->roots.distance;
  if (bodies->roots.overlap) {
    const SearchPose from = s.to_float(*bodies);
    s.set_pad(2 * s.pad_of(from) - margin, result);
    LeafPairSink sink(s.window, reducer);
    const Budget left = minus_root_test(budget);
    auto* shared = std::get_if<SharedSearch>(&s.searches);
    const Search::Stopped stopped =
        shared ? shared->run_until(left, from, sink) : s.serial().run_until(left, from, sink);
    s.set_steps(stopped.steps, result);
    result.sphere_tests += stopped.tests;
    result.leaf_pairs = stopped.leaf_pairs;
    if (result.leaf_pairs > 0) {
      result.distance->upper = std::min(result.distance->upper, result.resolution);
    }
  }
  reducer.finish();
  return result;
}

TrianglePairsResult Query::triangle_pairs(const Eigen::Isometry3d& pose,
                                          std::span<TrianglePair> out) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  if (!s.exact) return {.status = QueryStatus::kNoTriangles};
  const std::optional<detail::Approach> bodies = s.approach(pose, s.triangle_error(pose));
  if (!bodies) return {.status = QueryStatus::kInvalidPose};
  TrianglePairsResult result;
  result.sphere_tests = 1;
  if (!bodies->roots.overlap) return result;
  result.triangle_pairs = s.exact->pairs(*project_to_rigid(pose), s.to_float(*bodies), out);
  result.sphere_tests += s.exact->tests();
  result.truncated = result.triangle_pairs > out.size();
  return result;
}

bool Query::has_triangles() const noexcept { return state_->exact.has_value(); }
SpherePolicy Query::policy() const noexcept { return state_->policy; }
const char* Query::target() const noexcept { return state_->kernels.target; }
int Query::workers() const noexcept {
  return std::holds_alternative<SharedSearch>(state_->searches) ? 2 : 1;
}

std::size_t Query::bytes() const noexcept {
  const auto* shared = std::get_if<SharedSearch>(&state_->searches);
  return (shared != nullptr ? shared->bytes() : state_->serial().bytes()) +
         (state_->exact ? state_->exact->bytes() : 0) + state_->window.size() * sizeof(LeafPair);
}

Sharing Query::sharing() const noexcept {
  const auto* shared = std::get_if<SharedSearch>(&state_->searches);
  return shared != nullptr ? shared->sharing() : Sharing{};
}

}  // namespace ist
