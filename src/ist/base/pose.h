#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/api.h"

namespace ist {

/// Returns the rigid motion nearest to `pose`, or nullopt if a number is not finite, the last row
/// is not 0 0 0 1, the rotation is farther than 1e-5 from orthonormal (any entry of RᵀR - I), or
/// the rotation mirrors. The rotation of the result is orthonormal to a few 1e-16; an exactly
/// orthonormal one, such as the identity or a quarter turn, is returned bit for bit.
///
/// Cost: some 200 flops, no allocation. Source: the Newton iteration for the polar factor, N. J.
/// Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7(4), 1986, in the form
/// without an inverse, which converges quadratically from here.
[[nodiscard]] IST_API std::optional<Eigen::Isometry3d> project_to_rigid(
    const Eigen::Isometry3d& pose) noexcept;

/// Returns the motion `second` after `first`, projected to a rigid motion, or nullopt where
/// project_to_rigid returns it. For poses that accumulate many small motions: the result is rigid
/// to a few 1e-16, and rounding adds only a drift. With u = 2⁻⁵³, each composition turns the pose
/// by at most 20u radians and moves it by at most 8u (|first| + |second|), the lengths of both
/// translations. So 10⁷ compositions turn it by at most 2.3e-8 radians; most roundings cancel, and
/// 4e-11 was measured.
///
/// The bits are the same on every instruction set and for any MXCSR of the caller. Cost: 0.1 µs.
[[nodiscard]] IST_API std::optional<Eigen::Isometry3d> compose_rigid(
    const Eigen::Isometry3d& second, const Eigen::Isometry3d& first) noexcept;

}  // namespace ist
