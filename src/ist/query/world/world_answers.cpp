#include <algorithm>

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
void take_distance(const DistanceResult& result, WorldPair& pair) noexcept {
  take(result, pair);
  if (result.status == QueryStatus::kDone) pair.distance = result.distance;
  pair.narrowest = result.narrowest;
}

// Asks the query of a pair. The span of the question is free from `pair.first` on.
void ask_query(const WorldQuestion& question, Query& query, ContactManifold* manifold,
               const Eigen::Isometry3d& pose, const Budget& budget, WorldPair& pair) noexcept {
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
      const std::span<LeafPair> out = question.leaf_pairs.subspan(pair.first);
      take_leaf_pairs(query.leaf_pairs(pose, out, budget), pair);
      pair.written = std::min<std::uint64_t>(pair.found, out.size());
      break;
    }
    case WorldQuestion::kTrianglePairs: {
      const std::span<TrianglePair> out = question.triangle_pairs.subspan(pair.first);
      const TrianglePairsResult result = query.triangle_pairs(pose, out, budget);
      take(result, pair);
      pair.truncated = result.truncated;
      pair.found = result.triangle_pairs;
      pair.written = std::min<std::uint64_t>(pair.found, out.size());
      break;
    }
    case WorldQuestion::kDistance:
      take_distance(query.distance(pose, question.tolerance, budget), pair);
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
      if (s.table[pair] != PairTable::kIgnored) return true;
    }
  }
  return false;
}

}  // namespace

WorldAnswer World::ask(const WorldQuestion& question, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  WorldState& s = *state_;
  const Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  if (question.kind == WorldQuestion::kContacts) ++s.felt;
  if (!s.ready) return {.status = QueryStatus::kNotPrepared, .complete = false};
  s.find_near();
  const NearSet& near = s.answers.near;
  const std::span<WorldPair> pairs = std::span(s.answers.pairs).first(near.size());
  const bool truncated = near.count() > near.size();
  WorldAnswer all{
      .complete = !truncated, .truncated = truncated, .near_pairs = near.count(), .pairs = pairs};
  std::uint64_t written = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairAtPose& at = near[k];
    WorldPair& pair = pairs[k];
    pair = by_roots(at);
    if (question.kind == WorldQuestion::kNear) {
      ++all.sphere_tests;
      continue;
    }
    pair.first = written;
    if (at.status != QueryStatus::kDone || budget.is_past()) {
      fill_unasked(question.kind, pair);
    } else {
      WorldState::PairMemory& memory = s.memory(at);
      ask_query(question, memory.query, memory.manifold ? &*memory.manifold : nullptr,
                to_isometry(at.pose), BudgetMeter(budget, all.sphere_tests).rest(), pair);
      if (pair.manifold != nullptr) memory.felt = s.felt;
    }
    pair.rotation_error = s.rotation_error_of(pair.bodies);
    written += pair.written;
    all.sphere_tests += pair.sphere_tests;
    all.complete = all.complete && pair.status == QueryStatus::kDone && pair.complete;
  }
  return all;
}

const ContactManifold* World::manifold(BodyIndex a, BodyIndex b) const noexcept {
  const WorldState::PairMemory* const memory = state_->find(a, b);
  return memory != nullptr && memory->felt == state_->felt ? &*memory->manifold : nullptr;
}

WorldDistance World::distance(double tolerance, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  WorldState& s = *state_;
  const Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  if (!s.ready) return {.status = QueryStatus::kNotPrepared};

  double lower = s.find_candidates();  // of all pairs that are done with
  double upper = kLargestDistance;
  const std::vector<WorldState::Candidate>& candidates = s.answers.candidates;
  const std::span<WorldPair> pairs = std::span(s.answers.nearest).first(candidates.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k] = by_roots(s.look(candidates[k].bodies));
    fill_unasked(WorldQuestion::kDistance, pairs[k]);
    upper = std::min(upper, pairs[k].roots.upper);
  }
  std::sort(pairs.begin(), pairs.end(), [](const WorldPair& a, const WorldPair& b) {
    return a.roots.lower < b.roots.lower || (a.roots.lower == b.roots.lower && a.bodies < b.bodies);
  });

  const double width = tolerance > 0 ? tolerance : 0;
  std::uint64_t spent = 0;
  for (WorldPair& pair : pairs) {
    // No later pair is nearer than the roots of this one.
    const bool enough =
        pair.roots.lower > upper || upper - std::min(lower, pair.roots.lower) <= width;
    if (!enough && pair.status == QueryStatus::kDone && !budget.is_past()) {
      const PairAtPose at = s.look(pair.bodies);
      take_distance(s.memory(at).query.distance(to_isometry(at.pose), tolerance,
                                                BudgetMeter(budget, spent).rest()),
                    pair);
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
    if (all.nearest && !(end < least || (end == least && pair.bodies < *all.nearest))) continue;
    all.nearest = pair.bodies;
    least = end;
  }
  const bool lost = lacks_a_pose(s);
  if (lost) all.status = QueryStatus::kInvalidPose;
  all.complete = !lost && upper - all.distance.lower <= width;
  std::sort(pairs.begin(), pairs.end(),
            [](const WorldPair& a, const WorldPair& b) { return a.bodies < b.bodies; });
  all.pairs = pairs;
  return all;
}

}  // namespace ist
