#pragma once

#include <Eigen/Core>
#include <span>

#include "ist/base/progress.h"
#include "ist/measure/inside_parts.h"
#include "ist/measure/signed_distance.h"

namespace ist {

/// Measures those vertices of a surface that lie inside the body and beyond the reach, too. Of
/// vertices that hang together by edges shorter than the reach, and are all beyond it, one says
/// for all whether they are inside: no way between them meets the body's surface.
///
/// Returns false where `proceed` ended it.
///
/// @param points    the vertices of the surface, the body's coordinates
/// @param distances theirs, within the reach; completed
[[nodiscard]] bool measure_far_inside(const SurfaceInBody& side,
                                      std::span<const Eigen::Vector3d> points, double reach,
                                      std::span<SurfaceDistance> distances, const Proceed& proceed);

}  // namespace ist
