#pragma once

#include "ist/query/relative_pose.h"
#include "ist/query/search_step.h"

namespace ist {

/// A motion as the kernels read it, in float, with the pads that make their tests right: a pair
/// whose geometry meets is never dropped.
///
/// @param reaches of both trees, added (SphereTree::reach)
/// @param grow    added to the pads, mesh units
[[nodiscard]] SearchPose narrow(const RelativePose& pose, double reaches, double grow = 0) noexcept;

/// The same motion with larger pads: bounds touch that are no farther apart than `by`, mesh units.
[[nodiscard]] SearchPose grown(const SearchPose& pose, double by) noexcept;

}  // namespace ist
