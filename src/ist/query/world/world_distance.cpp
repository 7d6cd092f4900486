#include <algorithm>
#include <utility>

#include "ist/query/traversal/budget_meter.h"
#include "ist/query/world/not_asked.h"
#include "ist/query/world/world_state.h"

namespace ist {
namespace {

// Whether a pair that counts has a body without a valid pose.
bool lacks_a_pose(const detail::WorldState& s) noexcept {
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

WorldDistance World::distance(double tolerance, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::WorldState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy};
  if (!s.ready) return {.status = QueryStatus::kNotPrepared};

  double lower = s.find_candidates();  // of all pairs that are done with
  double upper = kLargestDistance;
  const std::vector<detail::WorldState::Candidate>& candidates = s.answers.candidates;
  const std::span<PairDistance> pairs = std::span(s.answers.nearest).first(candidates.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairAtPose at = s.look(candidates[k].bodies);
    pairs[k] = {};
    static_cast<NearPair&>(pairs[k]) = at.near;
    leave(at, pairs[k]);
    upper = std::min(upper, at.near.roots.upper);
  }
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& a, const NearPair& b) {
    return a.roots.lower < b.roots.lower || (a.roots.lower == b.roots.lower && a.bodies < b.bodies);
  });

  const double width = tolerance > 0 ? tolerance : 0;
  BudgetMeter meter(budget);
  for (PairDistance& pair : pairs) {
    // All pairs that are left are no nearer than this one's roots.
    const bool enough =
        pair.roots.lower > upper || upper - std::min(lower, pair.roots.lower) <= width;
    if (!enough && pair.status == QueryStatus::kDone && !budget.is_past()) {
      const PairAtPose at = s.look(pair.bodies);
      pair.result = s.memory(at).query.distance(to_isometry(at.pose), tolerance, meter.rest());
      meter.spend(pair.result.sphere_tests);
    }
    pair.result.rotation_error = s.rotation_error_of(pair.bodies);
    lower = std::min(lower, pair.result.distance.lower);
    upper = std::min(upper, pair.result.distance.upper);
  }

  WorldDistance all;
  all.distance = {std::min(lower, upper), upper};
  double least = kLargestDistance;
  for (const PairDistance& pair : pairs) {
    all.sphere_tests += pair.result.sphere_tests;
    const double end = pair.result.distance.upper;
    if (all.nearest && !(end < least || (end == least && pair.bodies < *all.nearest))) continue;
    all.nearest = pair.bodies;
    least = end;
  }
  const bool lost = lacks_a_pose(s);
  if (lost) all.status = QueryStatus::kInvalidPose;
  all.complete = !lost && upper - all.distance.lower <= width;
  std::sort(pairs.begin(), pairs.end(),
            [](const NearPair& a, const NearPair& b) { return a.bodies < b.bodies; });
  all.pairs = pairs;
  return all;
}

}  // namespace ist
