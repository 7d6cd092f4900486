#include <algorithm>
#include <utility>

#include "ist/query/traversal/budget_meter.h"
#include "ist/query/world/not_asked.h"
#include "ist/query/world/world_state.h"

namespace ist {
namespace {

using detail::Use;
using detail::WorldState;

// Begins an answer with the pairs that are near. Its status is other than kDone where there is
// none.
template <class Pair>
WorldAnswer<Pair> begin_answer(WorldState& s, const Use& use) noexcept {
  WorldAnswer<Pair> all;
  if (!use || !s.ready) {
    all.status = use ? QueryStatus::kNotPrepared : QueryStatus::kBusy;
    all.complete = false;
    return all;
  }
  s.find_near();
  const NearSet& near = s.answers.near;
  all.near_pairs = near.count();
  all.truncated = near.count() > near.size();
  all.complete = !all.truncated;
  return all;
}

// Asks all pairs that are near, in order.
template <class Pair, class Ask>
WorldAnswer<Pair> ask_all(WorldState& s, std::vector<Pair>& out, const Budget& budget,
                          Ask ask) noexcept {
  const Use use(s);
  WorldAnswer<Pair> all = begin_answer<Pair>(s, use);
  if (all.status != QueryStatus::kDone) return all;
  const NearSet& near = s.answers.near;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const PairAtPose& at = near[k];
    Pair& pair = out[k];
    pair = {};
    static_cast<NearPair&>(pair) = at.near;
    if (at.near.status != QueryStatus::kDone || budget.is_past()) {
      leave(at, pair);
    } else {
      ask(pair, s.memory(at), to_isometry(at.pose), BudgetMeter(budget, all.sphere_tests).rest());
    }
    pair.result.rotation_error = s.rotation_error_of(pair.bodies);
    all.sphere_tests += pair.result.sphere_tests;
    all.complete = all.complete && pair.result.status == QueryStatus::kDone && pair.result.complete;
  }
  all.pairs = {out.data(), near.size()};
  return all;
}

}  // namespace

WorldAnswer<NearPair> World::near_pairs() noexcept {
  const ScopedFloatEnvironment environment;
  WorldState& s = *state_;
  const Use use(s);
  WorldAnswer<NearPair> all = begin_answer<NearPair>(s, use);
  if (all.status != QueryStatus::kDone) return all;
  const NearSet& near = s.answers.near;
  for (std::size_t k = 0; k < near.size(); ++k) s.answers.pairs[k] = near[k].near;
  all.sphere_tests = near.size();
  all.pairs = {s.answers.pairs.data(), near.size()};
  return all;
}

WorldAnswer<PairIntersection> World::intersects(const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return ask_all(
      *state_, state_->answers.intersections, budget,
      [](PairIntersection& pair, WorldState::PairMemory& memory, const Eigen::Isometry3d& pose,
         const Budget& rest) { pair.result = memory.query.intersects(pose, rest); });
}

WorldAnswer<PairContacts> World::contacts(const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return ask_all(*state_, state_->answers.contacts, budget,
                 [](PairContacts& pair, WorldState::PairMemory& memory,
                    const Eigen::Isometry3d& pose, const Budget& rest) {
                   pair.result = memory.query.contacts(pose, memory.manifold, rest);
                   pair.manifold = &memory.manifold;
                 });
}

WorldAnswer<PairLeaves> World::leaf_pairs(std::span<LeafPair> out, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return ask_all(*state_, state_->answers.leaves, budget,
                 [&](PairLeaves& pair, WorldState::PairMemory& memory,
                     const Eigen::Isometry3d& pose, const Budget& rest) {
                   pair.result = memory.query.leaf_pairs(pose, out, rest);
                   const std::uint64_t given =
                       std::min<std::uint64_t>(pair.result.leaf_pairs, out.size());
                   pair.pairs = out.first(given);
                   out = out.subspan(given);
                 });
}

WorldAnswer<PairTriangles> World::triangle_pairs(std::span<TrianglePair> out,
                                                 const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return ask_all(*state_, state_->answers.triangles, budget,
                 [&](PairTriangles& pair, WorldState::PairMemory& memory,
                     const Eigen::Isometry3d& pose, const Budget& rest) {
                   pair.result = memory.query.triangle_pairs(pose, out, rest);
                   const std::uint64_t given =
                       std::min<std::uint64_t>(pair.result.triangle_pairs, out.size());
                   pair.pairs = out.first(given);
                   out = out.subspan(given);
                 });
}

WorldAnswer<PairDistance> World::distances(double tolerance, const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  return ask_all(
      *state_, state_->answers.distances, budget,
      [&](PairDistance& pair, WorldState::PairMemory& memory, const Eigen::Isometry3d& pose,
          const Budget& rest) { pair.result = memory.query.distance(pose, tolerance, rest); });
}

}  // namespace ist
