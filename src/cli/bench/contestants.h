#pragma once

#include <span>
#include <vector>

#include "cli/bench/contest.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// The contestants' names of the ways that ratios are made of.
inline constexpr const char *kPublishedWay = "published", *kFastWay = "IST",
                            *kSearchWay = "IST, a search a tick", *kKeptWay = "IST, pairs kept";

/// Returns all ways of this library to ask about two bodies: leaf pairs by the published query and
/// by the fast one, for each policy that both trees have, with one worker and two; contacts of a
/// hand that trembles, by a search at each tick and by pairs kept from tick to tick; and, where
/// both trees have triangles, touch, pairs of triangles and distance.
///
/// They refer to the trees and the poses, which must outlive them. Throws kMemoryLimit.
[[nodiscard]] std::vector<Contestant> contestants_of(const SphereTree& fixed,
                                                     const SphereTree& moving,
                                                     std::span<const BenchPose> poses);

}  // namespace ist::cli
