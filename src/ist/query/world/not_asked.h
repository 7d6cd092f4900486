#pragma once

#include "ist/query/world/near_set.h"
#include "ist/query/world/world.h"

namespace ist {

/// Gives a pair that was not asked its result: the status, and what the roots tell.
inline void leave(const PairAtPose& at, PairIntersection& pair) noexcept {
  pair.result = {.status = at.near.status};
  if (at.near.status != QueryStatus::kInvalidPose) pair.result.sphere_tests = 1;
}
inline void leave(const PairAtPose& at, QueryResult& result) noexcept {
  result = {.status = at.near.status, .complete = false};
  if (at.near.status == QueryStatus::kInvalidPose) return;
  result.sphere_tests = 1;
  result.distance = at.near.roots;
}
inline void leave(const PairAtPose& at, PairContacts& pair) noexcept { leave(at, pair.result); }
inline void leave(const PairAtPose& at, PairLeaves& pair) noexcept { leave(at, pair.result); }
inline void leave(const PairAtPose& at, PairTriangles& pair) noexcept {
  pair.result = {.status = at.near.status, .complete = false};
  if (at.near.status != QueryStatus::kInvalidPose) pair.result.sphere_tests = 1;
}
inline void leave(const PairAtPose& at, PairDistance& pair) noexcept {
  pair.result = {.status = at.near.status, .complete = false};
  if (at.near.status == QueryStatus::kInvalidPose) return;
  pair.result.sphere_tests = 1;
  pair.result.distance = at.near.roots;
  pair.result.narrowest = at.near.roots.upper - at.near.roots.lower;
}

}  // namespace ist
