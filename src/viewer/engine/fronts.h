#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/traversal/search_plan.h"
#include "ist/tree/sphere_tree.h"

namespace ist::viewer {

/// The pairs of nodes that overlap after one step of a query down both trees, by their indices.
struct StepFront {
  int fixed_level = 0, moving_level = 0;
  std::uint64_t tests = 0;                   ///< pairs of bounds that the step tested
  std::uint64_t pairs = 0;                   ///< all that overlap
  std::vector<std::uint32_t> fixed, moving;  ///< of each pair; the first kMostKept of them
};
inline constexpr std::size_t kMostKept = std::size_t{1} << 21;

/// Runs the query that Query::leaf_pairs() runs, down to the levels `last`, and keeps the front
/// after each step. Empty where the roots do not overlap. Throws kPolicyMissing.
[[nodiscard]] std::vector<StepFront> record_fronts(const SphereTree& fixed,
                                                   const SphereTree& moving, SpherePolicy policy,
                                                   const Eigen::Isometry3d& pose,
                                                   SearchLevels last = {});

/// Returns each node of a front once, ascending.
[[nodiscard]] std::vector<std::uint32_t> nodes_in(std::span<const std::uint32_t> of_pairs);

}  // namespace ist::viewer
