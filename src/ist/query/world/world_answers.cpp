#include <algorithm>

#include "ist/query/relative_pose.h"
#include "ist/query/traversal/budget_meter.h"
#include "ist/query/world/world_state.h"

namespace ist {
namespace {

using detail::Use;
using detail::WorldState;

// Returns the answer of a pair before its query is asked: the roots alone tell it.
WorldPair by_roots(const PairAtPose& at) noexcept {
  WorldPair pair;
  pair.bodies = at.bodies;
  pair.status = at.status;
  pair.roots = pair.distance = at.roots;
  return pair;
}

// Counts the test of the roots of a pair that a question or its budget left out.
void fill_unasked(WorldQuestion::Kind kind, WorldPair& pair) noexcept {
  if (pair.status == QueryStatus::kInvalidPose) return;
  pair.sphere_tests = 1;
  if (kind == WorldQuestion::kDistance) pair.narrowest = pair.roots.upper - pair.roots.lower;
}

// Takes the members that the results of all verbs have.
template <class Result>
void take(const Result& result, WorldPair& pair) noexcept {
  pair.status = result.status;
  pair.complete = result.complete;
  pair.sphere_tests = result.sphere_tests;
}
void take_leaf_pairs(const QueryResult& result, WorldPair& pair) noexcept {
  take(result, pair);
  pair.truncated = result.truncated;
  pair.way = result.found;
  pair.level = result.level;
  if (result.distance) pair.distance = *result.distance;
  pair.resolution = result.resolution;
  pair.pad = result.pad;
  pair.found = result.leaf_pairs;
}
// `fixed` is the pose of the fixed body in the world.
void take_distance(const DistanceResult& result, const BodyPose& fixed, WorldPair& pair) noexcept {
  take(result, pair);
  pair.nearest = result.nearest;
  if (pair.nearest) {
    const RelativePose pose{fixed.rotation, fixed.translation};
    pair.nearest->fixed_point = moved(pose, pair.nearest->fixed_point);
    pair.nearest->moving_point = moved(pose, pair.nearest->moving_point);
  }
  if (result.status == QueryStatus::kDone) pair.distance = result.distance;
  pair.narrowest = result.narrowest;
}

// Asks the query of a pair. The span of the question is free from `pair.first` on.
void ask_query(const WorldQuestion& question, Query& query, ContactManifold* manifold,
               const PairAtPose& at, const BodyPose& fixed, const Budget& budget,
               WorldPair& pair) noexcept {
  const Eigen::Isometry3d pose = to_isometry(at.pose);
  switch (question.kind) {
    case WorldQuestion::kNear:
      break;
    case WorldQuestion::kIntersects: {
      const IntersectionResult result = query.intersects(pose, budget);
      take(result, pair);
      pair.answer = result.answer;
      pair.resolution = result.resolution;
      break;
    }
    case WorldQuestion::kContacts:
      if (manifold == nullptr) {  // a body lacks voxels
        pair.status = QueryStatus::kNoVoxels;
        pair.complete = false;
        break;
      }
      take_leaf_pairs(query.contacts(pose, *manifold, budget), pair);
      pair.manifold = manifold;
      break;
    case WorldQuestion::kLeafPairs: {
      const std::span<LeafPair> out =
          question.leaf_pairs.subspan(static_cast<std::size_t>(pair.first));
      take_leaf_pairs(query.leaf_pairs(pose, out, budget), pair);
      pair.written = std::min<std::uint64_t>(pair.found, out.size());
      break;
    }
    case WorldQuestion::kTrianglePairs: {
      const std::span<TrianglePair> out =
          question.triangle_pairs.subspan(static_cast<std::size_t>(pair.first));
      const TrianglePairsResult result = query.triangle_pairs(pose, out, budget);
      take(result, pair);
      pair.truncated = result.truncated;
      pair.found = result.triangle_pairs;
      pair.written = std::min<std::uint64_t>(pair.found, out.size());
      break;
    }
    case WorldQuestion::kDistance:
      take_distance(query.distance(pose, question.tolerance, budget), fixed, pair);
      break;
  }
}

// Returns whether a pair that counts has a body without a valid pose.
bool lacks_a_pose(const WorldState& s) noexcept {
  const auto count = static_cast<BodyIndex>(s.bodies.size());
  for (BodyIndex lost = 0; lost < count; ++lost) {
    if (s.broad.has(lost)) continue;
    for (BodyIndex other = 0; other < count; ++other) {
      if (other == lost) continue;
      const BodyPair pair{std::min(lost, other), std::max(lost, other)};
      if (!s.ignored.has(pair)) return true;
    }
  }
  return false;
}

// Whether a question needs all leaf pairs of each pair.
bool is_of_leaves(WorldQuestion::Kind kind) noexcept {
  return kind == WorldQuestion::kContacts || kind == WorldQuestion::kLeafPairs;
}

// Whether the pairs of bodies share a span.
bool fills_a_span(WorldQuestion::Kind kind) noexcept {
  return kind == WorldQuestion::kLeafPairs || kind == WorldQuestion::kTrianglePairs;
}

// Keeps the memory of the pairs that are near, and gives pair caches to those that move slowly.
void prepare_memories(WorldState& s, WorldQuestion::Kind kind) noexcept {
  const NearSet& near = s.reserved.near;
  PairMemories& memories = s.reserved.memories;
  memories.keep(near.size(), [&](std::size_t k) { return near[k].bodies; });
  if (!is_of_leaves(kind)) return;
  detail::CacheSlots& slots = s.reserved.slots;
  slots.begin();
  for (std::size_t k = 0; k < near.size(); ++k) {
    const PairAtPose& at = near[k];
    if (at.status != QueryStatus::kDone) continue;
    const detail::AskedBody a = s.asked(at.bodies.a), b = s.asked(at.bodies.b);
    if (!a.facts.leaves || !b.facts.leaves) continue;
    slots.note(memories[k], at.pose, a, b,
               detail::QueryState::policy_of(a.tree, b.tree, s.options.query));
  }
}

}  // namespace

void detail::WorldState::ask_pair(std::size_t thread, std::size_t k,
                                  const Budget& budget) noexcept {
  const PairAtPose& at = reserved.near[k];
  WorldPair& pair = reserved.pairs[k];
  pair.rotation_error = rotation_error_of(pair.bodies);
  if (at.status != QueryStatus::kDone || budget.is_past()) {
    fill_unasked(round.question.kind, pair);
    return;
  }
  PairMemory& memory = reserved.memories[k];
  PairAsker& asker = *reserved.askers[thread];
  const bool of_leaves = is_of_leaves(round.question.kind);
  Query& query = asker.bind(asked(at.bodies.a), asked(at.bodies.b), memory, of_leaves,
                            of_leaves ? reserved.slots.of(memory) : nullptr);
  ContactManifold* manifold = nullptr;
  if (round.question.kind == WorldQuestion::kContacts && asker.has_leaves()) {
    manifold = &reserved.manifolds[k];
    asker.bind(*manifold);
  }
  ask_query(round.question, query, manifold, at, bodies[at.bodies.a].pose, budget, pair);
  asker.keep(memory);
}

WorldAnswer World::ask(const WorldQuestion& question, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  WorldState& s = *state_;
  const Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  WorldState::Reserved& reserved = s.reserved;
  if (question.kind == WorldQuestion::kContacts) reserved.felt.clear();
  if (!s.ready) return {.status = QueryStatus::kNotPrepared, .complete = false};
  s.find_near();
  const NearSet& near = reserved.near;
  const std::span<WorldPair> pairs = std::span(reserved.pairs).first(near.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k] = by_roots(near[k]);
  const bool truncated = near.count() > near.size();
  WorldAnswer all{
      .complete = !truncated, .truncated = truncated, .near_pairs = near.count(), .pairs = pairs};
  if (question.kind == WorldQuestion::kNear || pairs.empty()) {
    all.sphere_tests = pairs.size();
    if (question.kind != WorldQuestion::kNear) reserved.memories.clear();
    return all;
  }

  prepare_memories(s, question.kind);
  s.round = {question, budget};
  if (!fills_a_span(question.kind) && !budget.has_tests()) {
    reserved.pool->run(pairs.size());
  } else {
    std::uint64_t written = 0, spent = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      pairs[k].first = written;
      s.ask_pair(0, k, BudgetMeter(budget, spent).rest());
      written += pairs[k].written;
      spent += pairs[k].sphere_tests;
    }
  }
  for (const WorldPair& pair : pairs) {
    all.sphere_tests += pair.sphere_tests;
    all.complete = all.complete && pair.status == QueryStatus::kDone && pair.complete;
    if (pair.manifold != nullptr) reserved.felt.push_back({pair.bodies, pair.manifold});
  }
  return all;
}

const ContactManifold* World::manifold(BodyIndex a, BodyIndex b) const noexcept {
  const std::vector<WorldState::Felt>& felt = state_->reserved.felt;
  const BodyPair pair{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(
      felt.begin(), felt.end(), pair,
      [](const WorldState::Felt& one, BodyPair wanted) { return one.bodies < wanted; });
  return at != felt.end() && at->bodies == pair ? at->manifold : nullptr;
}

WorldDistance World::distance(double tolerance, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  WorldState& s = *state_;
  const Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  if (!s.ready) return {.status = QueryStatus::kNotPrepared};

  double lower = s.find_candidates();  // of all pairs that are done with
  double upper = kLargestDistance;
  std::vector<WorldState::Candidate>& candidates = s.reserved.candidates;
  PairMemories& memories = s.reserved.memories;
  memories.keep(candidates.size(), [&](std::size_t k) { return candidates[k].bodies; });
  const std::span<WorldPair> pairs = std::span(s.reserved.nearest).first(candidates.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k] = by_roots(s.look(candidates[k].bodies));
    fill_unasked(WorldQuestion::kDistance, pairs[k]);
    upper = std::min(upper, pairs[k].roots.upper);
    candidates[k].lower = pairs[k].roots.lower;
  }
  std::sort(candidates.begin(), candidates.end());

  const double width = tolerance > 0 ? tolerance : 0;
  std::uint64_t spent = 0;
  for (const WorldState::Candidate& candidate : candidates) {
    const std::size_t k = memories.place_of(candidate.bodies);
    WorldPair& pair = pairs[k];
    // No later candidate is nearer than the roots of this one.
    const bool enough =
        pair.roots.lower > upper || upper - std::min(lower, pair.roots.lower) <= width;
    if (!enough && pair.status == QueryStatus::kDone && !budget.is_past()) {
      const PairAtPose at = s.look(pair.bodies);
      PairMemory& memory = memories[k];
      detail::PairAsker& asker = *s.reserved.askers.front();
      Query& query =
          asker.bind(s.asked(pair.bodies.a), s.asked(pair.bodies.b), memory, false, nullptr);
      take_distance(
          query.distance(to_isometry(at.pose), tolerance, BudgetMeter(budget, spent).rest()),
          s.bodies[pair.bodies.a].pose, pair);
      asker.keep(memory);
      spent += pair.sphere_tests;
    }
    pair.rotation_error = s.rotation_error_of(pair.bodies);
    lower = std::min(lower, pair.distance.lower);
    upper = std::min(upper, pair.distance.upper);
  }

  WorldDistance all;
  all.distance = {std::min(lower, upper), upper};
  double least = kLargestDistance;
  for (const WorldPair& pair : pairs) {
    all.sphere_tests += pair.sphere_tests;
    const double end = pair.distance.upper;
    if (all.nearest && !(end < least)) continue;
    all.nearest = pair.bodies;
    least = end;
  }
  const bool lost = lacks_a_pose(s);
  if (lost) all.status = QueryStatus::kInvalidPose;
  all.complete = !lost && upper - all.distance.lower <= width;
  all.pairs = pairs;
  return all;
}

}  // namespace ist
