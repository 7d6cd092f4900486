#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "query/query_cases.h"

namespace ist::test {

/// Two trees and the way down them, and how all of their nodes are named on it.
struct PlannedSearch {
  PlannedSearch(SphereTree a, SphereTree b, SpherePolicy with);
  PlannedSearch(const PlannedSearch&) = delete;
  PlannedSearch& operator=(const PlannedSearch&) = delete;

  struct Names {
    std::vector<std::uint32_t> fixed, moving;
  };
  SphereTree fixed, moving;
  SpherePolicy policy;
  SearchPlan plan;
  std::vector<Names> names;  ///< before each step
};

/// For every policy: bodies of one voxel and of some thousand, of equal voxels and of others, so
/// that in some steps both sides are opened, in some the fixed and in some the moving one alone,
/// at the top and at the bottom.
[[nodiscard]] const std::vector<std::unique_ptr<PlannedSearch>>& all_plans();

/// A motion that brings the moving body near the fixed one, with pads from nothing up to `most`.
[[nodiscard]] SearchPose random_pose(Random& random, double most);

}  // namespace ist::test
