#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "ist/tree/bounds.h"
#include "ist/tree/lookup_table.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/lattice.h"

namespace ist {

/// Whether the policy's spheres follow from the octree alone.
[[nodiscard]] constexpr bool is_implicit(SpherePolicy policy) noexcept {
  return policy == SpherePolicy::kSimple || policy == SpherePolicy::kTable;
}

/// Returns the published bounding sphere of a node in the tree's frame, under one of the two
/// implicit policies.
///
/// @param cube_centre centre of the node's cube, in voxel edges from the root cube's centre: exact
/// in double
/// @param mask the node's occupancy mask, not 0; ignored for a leaf, whose sphere is the
/// circumsphere
///
/// Source: the article that introduces the method, equation (3), and its lookup table; E. Ruffaldi
/// et al., The implicit sphere tree, World Haptics 2005.
[[nodiscard]] inline Ball implicit_ball(SpherePolicy policy, const Lattice& lattice, int level,
                                        const Eigen::Vector3d& cube_centre,
                                        std::uint8_t mask) noexcept {
  const double half = 0.5 * static_cast<double>(std::uint64_t{1} << level);
  const double s = lattice.voxel_size;
  if (policy == SpherePolicy::kSimple || level == 0) return {s * cube_centre, s * (half * kSqrt3)};
  const TableBall& ball = kLookupTable[mask];
  const double sixth = half / 6;
  return {{s * (cube_centre[0] + sixth * ball.x), s * (cube_centre[1] + sixth * ball.y),
           s * (cube_centre[2] + sixth * ball.z)},
          s * (half * kTableRadii[kTableWords[mask] >> 9])};
}

/// Returns the radius of a table ball that holds the circumspheres of all leaves below its node, so
/// that bounds are nested: larger than the published one by leaf_excess(). Mesh units.
[[nodiscard]] inline double nested_radius(const Lattice& lattice, int level,
                                          std::size_t radius_code) noexcept {
  const double half = 0.5 * static_cast<double>(std::uint64_t{1} << level);
  return lattice.voxel_size * (half * kTableRadii[radius_code] + leaf_excess(level, radius_code));
}

/// Returns the sphere that the traversal tests: as implicit_ball(), with the nested radius.
[[nodiscard]] inline Ball nested_ball(SpherePolicy policy, const Lattice& lattice, int level,
                                      const Eigen::Vector3d& cube_centre,
                                      std::uint8_t mask) noexcept {
  Ball ball = implicit_ball(policy, lattice, level, cube_centre, mask);
  if (policy == SpherePolicy::kTable && level > 0) {
    ball.radius = nested_radius(lattice, level, kTableWords[mask] >> 9);
  }
  return ball;
}

}  // namespace ist
