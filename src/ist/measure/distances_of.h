#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ist/base/progress.h"
#include "ist/measure/point_search.h"
#include "ist/measure/signed_distance.h"

namespace ist {

/// Returns the answer for a point that is farther than the reach.
[[nodiscard]] SurfaceDistance beyond_reach();

/// Measures points as signed_distance() does, on all cores; the first of them, where `proceed` ends
/// it. `search` is the tree's; the points are finite.
[[nodiscard]] std::vector<SurfaceDistance> distances_of(const SphereTree& tree,
                                                        const PointSearch& search,
                                                        std::span<const Eigen::Vector3d> points,
                                                        double reach, const Proceed& proceed = {});

}  // namespace ist
