#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "ist/tree/ball.h"
#include "ist/tree/lookup_table.h"
#include "ist/voxel/lattice.h"

namespace ist {

/// How an octree node is read as a sphere.
enum class SpherePolicy : std::uint8_t {
  kSimple,  ///< the circumsphere of the node's cube
  kTable,   ///< the smallest ball round the children's cubes, from the lookup table
  kTight,   ///< the ball round the triangles clipped to the cube, saved with the tree
  kSlab,    ///< the tight ball, cut by a thin slab round the same triangles, saved too
};

/// All of them, from the loosest to the tightest.
inline constexpr std::array kSpherePolicies = {SpherePolicy::kSimple, SpherePolicy::kTable,
                                               SpherePolicy::kTight, SpherePolicy::kSlab};

[[nodiscard]] constexpr std::string_view to_string(SpherePolicy policy) noexcept {
  switch (policy) {
    case SpherePolicy::kSimple:
      return "simple";
    case SpherePolicy::kTable:
      return "table";
    case SpherePolicy::kTight:
      return "tight";
    case SpherePolicy::kSlab:
      return "slab";
  }
  return "";
}

[[nodiscard]] constexpr std::optional<SpherePolicy> sphere_policy(std::string_view name) noexcept {
  for (const SpherePolicy policy : kSpherePolicies) {
    if (name == to_string(policy)) return policy;
  }
  return std::nullopt;
}

/// Whether a node's sphere follows from the octree alone.
[[nodiscard]] constexpr bool is_implicit(SpherePolicy policy) noexcept {
  return policy == SpherePolicy::kSimple || policy == SpherePolicy::kTable;
}

/// √3, rounded up: the circumradius of a cube by half its edge.
inline constexpr double kSqrt3 = 1.7320508075688774;

/// The square roots of TableBall::radius_squared / 36, rounded up: radii by half the node's edge.
inline constexpr struct TableRadii {
  [[nodiscard]] constexpr double operator[](int radius_squared) const noexcept {
    switch (radius_squared) {
      case 27:
        return 0.8660254037844387;  // √3/2
      case 54:
        return 1.2247448713915892;  // √6/2
      case 81:
        return 1.5;
      case 96:
        return 1.632993161855452;  // √24/3
      default:
        return kSqrt3;
    }
  }
} kTableRadii;

/// The sphere of a node in the tree's frame, for the two implicit policies.
///
/// @param cube_centre of the node, in voxel edges from the root cube's centre: exact in double
/// @param mask the node's occupancy; not looked at for a leaf, whose sphere is the circumsphere
///
/// Source: the article that the method comes from, equation (3), and its lookup table; E. Ruffaldi
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
          s * (half * kTableRadii[ball.radius_squared])};
}

}  // namespace ist
