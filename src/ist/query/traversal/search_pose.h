#pragma once

#include "ist/query/relative_pose.h"
#include "simd/step.h"

namespace ist {

/// Narrows a motion to float, as the kernels read it, with pads that bound the rounding error of
/// their tests: no pair whose bounds overlap is dropped.
///
/// @param bounding_radii the bounding radii of both trees, added (SphereTree::bounding_radius)
/// @param margin  added to the pads, mesh units
[[nodiscard]] SearchPose to_float(const RelativePose& pose, double bounding_radii,
                                  double margin = 0) noexcept;

/// Returns the pose with larger pads: bounds no farther apart than `by`, mesh units, count as
/// overlapping.
[[nodiscard]] SearchPose inflated(const SearchPose& pose, double by) noexcept;

}  // namespace ist
