#include "ist/query/query_state.h"

#include <fmt/format.h>

#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "ist/query/query_rules.h"
#include "ist/query/relative_pose.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/tree_parts.h"
#include "simd/dispatch.h"

namespace ist::detail {
namespace {

// A stream is given at most this number of leaf pairs at once.
constexpr std::size_t kWindow = 1 << 12;

// Returns the fixed tree of two that can be compared, and that answer a question together.
const SphereTree& comparable(const SphereTree& fixed, const SphereTree& moving,
                             const QueryOptions& options) {
  const std::string reason = contradiction(fixed, "the fixed tree", moving, "the moving tree");
  if (!reason.empty()) throw Error(ErrorCode::kArgumentInvalid, "query: " + reason);
  if (options.policy) {
    fixed.require(*options.policy, "fixed");
    moving.require(*options.policy, "moving");
  }
  const std::string nothing = lacks_common(fixed, "the fixed tree", moving, "the moving tree");
  if (!nothing.empty()) throw Error(ErrorCode::kVoxelsMissing, "query: " + nothing);
  return fixed;
}

const SphereTree& first(const SphereTree* tree, const SphereTree& other) noexcept {
  return tree != nullptr ? *tree : other;
}

// Makes the plan of two trees if both have voxels. Returns whether it did.
bool make_plan(std::optional<SearchPlan>& plan, const SphereTree& fixed, const SphereTree& moving,
               const QueryOptions& options, const QueryRoom& room) {
  const SphereTree &a = first(room.voxels, fixed), &b = first(room.voxels, moving);
  if (!a.has_voxels() || !b.has_voxels()) return false;
  plan.emplace(a, b, QueryState::policy_of(a, b, options));
  return true;
}

bool have_triangles(const SphereTree& fixed, const SphereTree& moving,
                    const QueryRoom& room) noexcept {
  return first(room.triangles, fixed).triangles() != nullptr &&
         first(room.triangles, moving).triangles() != nullptr;
}

// Returns the bytes that a query reserves for the leaves of such a plan.
std::size_t bytes_of_leaves(const SearchPlan& plan, const QueryOptions& options,
                            const QueryRoom& room) {
  std::size_t bytes =
      (options.workers == 2 ? SharedSearch::bytes_for(plan, options.frontier_pairs)
                            : Search::bytes_for(plan, options.frontier_pairs, room.search_items)) +
      (kWindow + kLeafPairSpare) * sizeof(LeafPair);
  if (options.front_pairs > 0) {
    bytes += CachedSearch::bytes_for(plan, cache_options(options));
  }
  return bytes;
}

TriangleOptions triangle_options(const QueryOptions& options, const QueryRoom& room) {
  return {options.workers, options.period, options.near_pairs, room.cluster_items};
}

// Returns the bytes that a query with such a plan reserves. Throws kArgumentInvalid for an option
// out of range.
std::size_t bytes_with(const std::optional<SearchPlan>& plan, const SphereTree& fixed,
                       const SphereTree& moving, const QueryOptions& options,
                       const QueryRoom& room) {
  if (options.workers != 1 && options.workers != 2) {
    throw_error(ErrorCode::kArgumentInvalid, "query option workers is {}: give 1 or 2",
                options.workers);
  }
  for (const auto& [name, pairs] :
       {std::pair{"front_pairs", options.front_pairs}, {"near_pairs", options.near_pairs}}) {
    if (pairs <= kMostItems) continue;
    throw_error(ErrorCode::kArgumentInvalid, "query option {} is {}: {} is the most", name, pairs,
                kMostItems);
  }
  std::size_t bytes = plan ? bytes_of_leaves(*plan, options, room) : 0;
  if (have_triangles(fixed, moving, room)) {
    bytes += TriangleSearch::bytes_for(first(room.triangles, fixed), first(room.triangles, moving),
                                       triangle_options(options, room));
  }
  return bytes;
}

// Narrows the interval of the roots' distance by the tests of a search. Bounds were inflated by the
// margin, and by pads that cover the rounding of a test.
DistanceInterval narrowed(const Approach& bodies, const DistanceBounds& bounds, Measured measured,
                          bool complete) noexcept {
  auto [lower, upper] = bodies.roots.distance;
  // If the search is incomplete, surfaces in a pair of nodes that was not descended may intersect.
  if (complete && measured == Measured::kBoth) {
    lower = std::max(lower, bounds.lower + bodies.margin);
  }
  // A complete result is the same without a budget and with one that measures the upper end alone.
  if (!complete || measured == Measured::kBoth) {
    upper = std::min(upper, bounds.upper - bodies.margin);
  }
  return {lower, upper};
}

}  // namespace

std::string lacks_common(const SphereTree& a, std::string_view a_name, const SphereTree& b,
                         std::string_view b_name) {
  const auto half = [](const SphereTree& one, const SphereTree& other) {
    return !one.has_voxels() && other.triangles() == nullptr;
  };
  if (half(b, a)) std::swap(a_name, b_name);
  if (!half(a, b) && !half(b, a)) return {};
  return fmt::format(
      "{} has no voxels, and {} no triangles: build the first with a voxel size, or the second "
      "with its triangles",
      a_name, b_name);
}

QueryState::QueryState(const SphereTree& fixed_tree, const SphereTree& moving_tree,
                       const QueryOptions& options, const ScopedFloatEnvironment&,
                       const QueryRoom& room)
    : fixed(comparable(fixed_tree, moving_tree, options)),
      moving(moving_tree),
      wanted_policy(options.policy),
      policy(policy_of(fixed, moving, options)),
      kernels(select_kernels(options.target)),
      workers(options.workers),
      has_plan(make_plan(plan, fixed, moving, options, room)),
      is_bound(room.voxels == nullptr && room.triangles == nullptr),
      bytes(bytes_with(plan, fixed, moving, options, room)) {
  if (plan) reserve_leaves(options, room);
  if (have_triangles(fixed, moving, room)) {
    triangles = &own_triangles.emplace(first(room.triangles, fixed), first(room.triangles, moving),
                                       kernels, triangle_options(options, room));
  }
}

void QueryState::reserve_leaves(const QueryOptions& options, const QueryRoom& room) {
  if (options.workers == 2) {
    searches.emplace<SharedSearch>(*plan, kernels, options.frontier_pairs, options.period);
  } else {
    searches.emplace<Search>(*plan, kernels, options.frontier_pairs, room.search_items);
  }
  if (options.front_pairs > 0) {
    cached = &own_cache.emplace(fixed, moving, policy, *plan, kernels, cache_options(options));
  }
  window.resize(kWindow + kLeafPairSpare);
}

std::size_t QueryState::bytes_for(const SphereTree& fixed, const SphereTree& moving,
                                  const QueryOptions& options, const QueryRoom& room) {
  std::optional<SearchPlan> plan;
  make_plan(plan, comparable(fixed, moving, options), moving, options, room);
  return bytes_with(plan, fixed, moving, options, room);
}

void QueryState::bind(const SphereTree& fixed_tree, const TreeFacts& of_fixed,
                      const SphereTree& moving_tree, const TreeFacts& of_moving,
                      bool of_leaves) noexcept {
  if (!is_bound || &parts_of(fixed_tree) != &parts_of(fixed) ||
      &parts_of(moving_tree) != &parts_of(moving)) {
    fixed = fixed_tree;
    moving = moving_tree;
    policy = wanted_policy.value_or(std::min(fixed.tightest(), moving.tightest()));
    has_plan = false;
    is_bound = true;
    const bool both = fixed.triangles() != nullptr && moving.triangles() != nullptr;
    triangles = both ? &*own_triangles : nullptr;
    if (both) triangles->bind(fixed, of_fixed.triangles, moving, of_moving.triangles);
  }
  if (triangles != nullptr) triangles->witnesses() = {};
  const bool may_plan = of_fixed.leaves && of_moving.leaves;
  if (has_plan || !may_plan || !(of_leaves || triangles == nullptr)) return;
  plan->bind(fixed, of_fixed.leaves->shape, moving, of_moving.leaves->shape, policy);
  std::get_if<Search>(&searches)->bind();
  has_plan = true;
}

double QueryState::triangle_error(const Eigen::Isometry3d& pose) const noexcept {
  // Bounds are inflated by the rounding error of a moved vertex, so that triangles which intersect
  // only after rounding are found (docs/guarantees.md, Triangles moved in double).
  return triangles ? triangles->moved_error(pose) : 0;
}

std::optional<Approach> QueryState::approach(const Eigen::Isometry3d& pose,
                                             double margin) const noexcept {
  const auto relative = relative_pose(pose, parts_of(fixed).origin, parts_of(moving).origin);
  if (!relative) return std::nullopt;
  return Approach{*relative, test_roots(fixed, moving, policy, *relative, margin), margin};
}

SearchPose QueryState::to_float(const Approach& approach, double margin) const noexcept {
  return ist::to_float(approach.relative, lengths_of(fixed, policy), lengths_of(moving, policy),
                       approach.margin + margin);
}

double QueryState::pad_of(const SearchPose& pose) const noexcept {
  return policy == SpherePolicy::kSlab ? pose.leaf.slab_fixed : pose.leaf.ball;
}

Search& QueryState::serial() noexcept {
  auto* shared = std::get_if<SharedSearch>(&searches);
  return shared != nullptr ? shared->serial() : *std::get_if<Search>(&searches);
}

void QueryState::set_pad(double pad, QueryResult& result) const noexcept {
  result.pad = pad;
  result.resolution = resolution_of(result, fixed, moving, policy);
}

QueryResult QueryState::root_result(const RootTest& roots, double margin) const noexcept {
  QueryResult result;
  result.sphere_tests = 1;
  set_pad(2 * roots.pad + margin, result);
  result.distance = roots.distance;
  if (!roots.overlap) result.found = Found::kClear;
  return result;
}

QueryResult QueryState::list(const Eigen::Isometry3d& pose, const Budget& budget,
                             LeafPairSink& sink) noexcept {
  const std::optional<Approach> bodies = approach(pose);
  if (!bodies) return invalid_pose(pose);
  QueryResult result = root_result(bodies->roots);
  result.rotation_error = rotation_error(pose);
  if (!bodies->roots.overlap) return result;
  const DistanceInterval distance =
      search<PairLister>(*bodies, to_float(*bodies), budget,
                         budget.is_limited() ? Measured::kBoth : Measured::kNothing, sink, result);
  // Without a limit a search measures nothing. A clearance is known anyway.
  const bool tells = budget.is_limited() || result.found == Found::kClear;
  result.distance = tells ? std::optional(distance) : std::nullopt;
  return result;
}

template <class Lister>
DistanceInterval QueryState::search(const Approach& bodies, const SearchPose& pose,
                                    const Budget& budget, Measured measured,
                                    typename Lister::Sink& sink, QueryResult& result) noexcept {
  set_pad(2 * pad_of(pose) - bodies.margin, result);
  const bool keeps = cached && !budget.has_tests();
  CachedSearch::CacheAt found;
  if (keeps) found = cached->find(bodies.relative, bodies.margin, budget);
  if (found.cache != nullptr) return answer_from(found, bodies, pose, budget, sink, result);

  // The test of the roots counts against a limit of tests.
  const BudgetMeter meter(budget, budget.has_tests() ? result.sphere_tests : 0);
  const SharedSearch::End end = search_afresh<Lister>(pose, meter, measured, sink);
  result.sphere_tests += end.tests - meter.spent() + found.tests;
  result.leaf_pairs = end.leaf_pairs;
  result.truncated = sink.truncated();
  result.level = static_cast<int>(plan->steps().size() - end.steps);
  result.complete = result.level == 0;
  if (keeps && result.complete) {
    cached->prepare(bodies.relative, bodies.margin, result.leaf_pairs, end.tests, budget);
  }
  return narrowed(bodies, end.bounds, measured, result.complete);
}

template <class Lister>
SharedSearch::End QueryState::search_afresh(const SearchPose& pose, const BudgetMeter& meter,
                                            Measured measured,
                                            typename Lister::Sink& sink) noexcept {
  if (auto* shared = std::get_if<SharedSearch>(&searches)) {
    return shared->run<Lister>(pose, sink, meter, measured);
  }
  Lister lister(pose, sink, meter, measured);
  const std::size_t steps = serial().run(lister);
  return {steps, lister.tests(), sink.count(), lister.bounds()};
}

template <class Sink>
DistanceInterval QueryState::answer_from(const CachedSearch::CacheAt& found, const Approach& bodies,
                                         const SearchPose& pose, const Budget& budget, Sink& sink,
                                         QueryResult& result) noexcept {
  const PairCache& cache = *found.cache;
  result.found = found.tests > 0 ? Found::kFresh : cache.empty() ? Found::kClear : Found::kKept;
  result.sphere_tests += found.tests + cache.lanes.pair_count;
  result.complete = cached->pass_on(cache, pose, budget, sink);
  if (!result.complete) {
    if (!sink.stopped()) sink.clear();  // the pairs that were passed on are not repeatable
    result.level = static_cast<int>(plan->steps().size());
  }
  result.leaf_pairs = sink.count();
  result.truncated = sink.truncated();
  auto [lower, upper] = bodies.roots.distance;
  if (result.leaf_pairs > 0) upper = std::min(upper, result.resolution);
  if (cache.empty()) {
    lower = std::max(lower, cache.extent - found.motion);
    upper = std::min(upper, found.upper);
  }
  if (result.complete) {
    cached->prepare(bodies.relative, bodies.margin, result.leaf_pairs, found.tests, budget);
  }
  return {lower, upper};
}

template DistanceInterval QueryState::search<PairLister>(const Approach&, const SearchPose&,
                                                         const Budget&, Measured, LeafPairSink&,
                                                         QueryResult&) noexcept;
template DistanceInterval QueryState::search<ContactVisitor>(const Approach&, const SearchPose&,
                                                             const Budget&, Measured,
                                                             ContactOutput&, QueryResult&) noexcept;

}  // namespace ist::detail
