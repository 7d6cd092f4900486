#pragma once

#include "ist/query/relative_pose.h"
#include "ist/tree/sphere_tree.h"
#include "simd/step.h"

namespace ist {

/// The lengths of a tree from which the pads of a search follow, mesh units.
struct TreeLengths {
  double bounding_radius, voxel_size, largest_leaf;
};
[[nodiscard]] TreeLengths lengths_of(const SphereTree& tree, SpherePolicy policy) noexcept;

/// Narrows a motion to float, as the kernels read it, with pads that bound the rounding error of
/// their tests. No pair of leaves whose bounds overlap is dropped, and no pair of nodes above two
/// leaves that the kernels keep (docs/guarantees.md, Search pose in float).
///
/// @param margin bounds that are no farther apart, mesh units, count as overlapping
[[nodiscard]] SearchPose to_float(const RelativePose& pose, const TreeLengths& fixed,
                                  const TreeLengths& moving, double margin = 0) noexcept;

/// Returns a distance, mesh units, that no pair of leaves exceeds which the kernels keep at that
/// pose: the margin, and twice the pad.
[[nodiscard]] double most_apart(const RelativePose& pose, const TreeLengths& fixed,
                                const TreeLengths& moving, double margin = 0) noexcept;

/// Returns the pose with a margin that is larger by `by`, mesh units. The pads of inner slabs may
/// be larger than those that to_float() would give.
[[nodiscard]] SearchPose inflated(const SearchPose& pose, double by) noexcept;

/// Returns the pad of balls of inner nodes, in double: a finite number for any finite motion.
///
/// @param bounding_radii the bounding radii of both trees, added
/// @param farthest the largest coordinate, without its sign, of the translation between their
///                 frames
[[nodiscard]] double inner_ball_pad(double bounding_radii, double farthest, double margin) noexcept;

}  // namespace ist
