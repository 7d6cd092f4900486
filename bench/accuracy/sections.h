#pragma once

#include <vector>

#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {

/// Each registers its benchmarks, which measure one kind of error beside the time it takes.

/// first/SIZE/POLICY, and of one size first/SIZE/exact and first/SIZE/touches, which wants a yes or
/// no of triangles: how far apart surfaces are when they are first said to touch, and what the pose
/// takes that is slowest, of the closing and of the ways' first contacts.
void add_first_contacts();
/// gap/SIZE/POLICY/DISTANCE and gap/SIZE/exact-TOLERANCE/DISTANCE: the interval's width, and its
/// time.
void add_gaps();
/// verdict/SIZE/POLICY: yes and no against exact triangles, and leaf pairs against them too.
void add_verdicts();
/// form/SIZE/POLICY: depths and normals of contact points on bodies whose surfaces are known.
void add_forms();
/// force/SIZE/POLICY: the force of a contact beside that of the finest voxels.
void add_forces();
/// deadline/BUDGET/DISTANCE: the interval that a query with that budget, in microseconds, gives.
void add_deadlines();

/// Voxel sizes that are compared, mm, the finest last.
[[nodiscard]] inline std::vector<double> accuracy_sizes() {
  if (quick()) return {0.8, 0.4};
  return {1.6, 0.8, 0.4, 0.2, 0.1};
}

[[nodiscard]] inline QueryOptions with_policy(SpherePolicy policy) {
  QueryOptions options;
  options.policy = policy;
  return options;
}

}  // namespace ist::bench
