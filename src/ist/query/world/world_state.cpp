#include "ist/query/world/world_state.h"

#include <cstring>

#include "ist/base/pose.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/traversal/root_test.h"
#include "ist/tree/tree_parts.h"

namespace ist {

void NearSet::clear() noexcept {
  pairs_.clear();
  order_.clear();
  count_ = 0;
}

void NearSet::add(const PairAtPose& pair) noexcept {
  ++count_;
  Entry entry{pair.bodies, static_cast<std::uint32_t>(order_.size())};
  if (order_.size() < room_) {  // both lists have this room
    pairs_.push_back(pair);
    order_.push_back(entry);
    if (order_.size() == room_) std::make_heap(order_.begin(), order_.end());
    return;
  }
  if (room_ == 0 || !(entry < order_.front())) return;
  std::pop_heap(order_.begin(), order_.end());
  entry.at = order_.back().at;
  pairs_[entry.at] = pair;
  order_.back() = entry;
  std::push_heap(order_.begin(), order_.end());
}

void NearSet::finish() noexcept { std::sort(order_.begin(), order_.end()); }

}  // namespace ist

namespace ist::detail {
namespace {

constexpr DistanceInterval kUnknown = {0, kLargestDistance};

// An upper bound of the rounding error of a moved triangle (TriangleSearch::moved_error): no vertex
// lies beyond the bounding radius.
double moved_error(const SphereTree& moving, const BodyPose& pose) noexcept {
  const Eigen::Vector3d origin = moving.origin();
  return 0x1p-48 * ((origin.cwiseAbs().maxCoeff() + moving.bounding_radius()) +
                    pose.translation.cwiseAbs().maxCoeff());
}

}  // namespace

void WorldState::move(BodyIndex index, const Eigen::Isometry3d& pose) noexcept {
  Body& body = bodies[index];
  const double* const numbers = pose.matrix().data();
  // Bit by bit, so that a NaN equals itself.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  if (std::memcmp(body.given.data(), numbers, sizeof body.given) == 0) return;
  std::copy_n(numbers, body.given.size(), body.given.begin());
  stale = true;
  body.rotation_error = rotation_error(pose);
  const std::optional<BodyPose> rigid = body_pose(pose);
  if (!rigid) {
    broad.take_out(index);
    return;
  }
  body.pose = *rigid;
  broad.set(index, ball_of(body.tree, body.pose, options.reach, options.manifold.reach));
}

PairAtPose WorldState::look(BodyPair pair) const noexcept {
  PairAtPose at{pair, QueryStatus::kInvalidPose, kUnknown, true, {}};
  if (!broad.has(pair.a) || !broad.has(pair.b)) return at;
  const SphereTree &a = bodies[pair.a].tree, &b = bodies[pair.b].tree;
  at.pose = between(bodies[pair.a].pose, bodies[pair.b].pose);
  const auto relative = relative_pose(to_isometry(at.pose), parts_of(a).origin, parts_of(b).origin);
  if (!relative) {  // no double holds the way: over a third of the largest is between them
    at.status = QueryStatus::kNotPrepared;
    at.roots = {0.25 * kLargestDistance, kLargestDistance};
    at.overlap = false;
    return at;
  }
  const double margin = std::max(
      {options.reach, ContactScale(a, b, options.manifold.margin, options.manifold.reach).reach,
       moved_error(b, at.pose)});
  const RootTest roots =
      test_roots(a, b, QueryState::policy_of(a, b, options.query), *relative, margin);
  at.overlap = roots.overlap;
  at.roots = roots.distance;
  at.status = QueryStatus::kDone;
  return at;
}

void WorldState::find_near() noexcept {
  if (!stale) return;
  stale = false;
  NearSet& near = reserved.near;
  near.clear();
  const auto add = [&](BodyPair pair) {
    if (ignored.has(pair)) return;
    const PairAtPose at = look(pair);
    if (at.overlap) near.add(at);
  };
  broad.near(add);
  const auto count = static_cast<BodyIndex>(bodies.size());
  for (BodyIndex lost = 0; lost < count; ++lost) {
    if (broad.has(lost)) continue;
    for (BodyIndex a = 0; a < lost; ++a) add({a, lost});
    for (BodyIndex b = lost + 1; b < count; ++b) {
      if (broad.has(b)) add({lost, b});  // else it was added above
    }
  }
  near.finish();
}

double WorldState::find_candidates() noexcept {
  std::vector<Candidate>& list = reserved.candidates;
  list.clear();
  double within = kLargestDistance, rest = kLargestDistance;
  broad.nearest([&](BodyPair pair, const DistanceInterval& distance) {
    if (ignored.has(pair)) return false;
    within = std::min(within, distance.upper);
    const Candidate candidate{distance.lower, pair};
    if (list.size() < reserved.room) {
      list.push_back(candidate);
      if (list.size() == reserved.room) std::make_heap(list.begin(), list.end());
      return true;
    }
    // The one farthest away leaves.
    double left = candidate.lower;
    if (candidate < list.front()) {
      left = list.front().lower;
      std::pop_heap(list.begin(), list.end());
      list.back() = candidate;
      std::push_heap(list.begin(), list.end());
    }
    rest = std::min(rest, left);
    return true;
  });
  std::erase_if(list, [&](const Candidate& candidate) { return candidate.lower > within; });
  std::sort(list.begin(), list.end(),
            [](const Candidate& a, const Candidate& b) { return a.bodies < b.bodies; });
  return rest;
}

}  // namespace ist::detail
