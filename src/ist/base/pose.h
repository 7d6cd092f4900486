#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "ist/base/api.h"

namespace ist {

// The library reads the poses of its callers, and writes the poses that it returns, by vectors of
// 16 bytes. -mavx and -mavx512f give them a larger alignment in a program. This does no harm: a
// pose always lies in the caller's memory.
#if EIGEN_ARCH_x86_64 || EIGEN_ARCH_ARM64
static_assert(alignof(Eigen::Isometry3d) >= 16,
              "IST needs poses aligned by 16 bytes or more: remove EIGEN_DONT_ALIGN, "
              "EIGEN_DONT_ALIGN_STATICALLY, or an EIGEN_MAX_ALIGN_BYTES below 16");
#endif

/// A motion, a velocity or a wrench: three numbers of translation, then three of rotation about a
/// point. In the loop a motion is in m and rad, a velocity in m/s and rad/s, a wrench in N and N m
/// about the tool's origin, and axes are the scene's.
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
/// The derivative of a wrench by a motion: N/m, N and N m. The layout is the same for every
/// instruction set.
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// Returns the rigid motion nearest to `pose`, or nullopt if `pose` is no rigid motion
/// (why_not_rigid). The rotation of the result is orthonormal to a few 1e-16; an exactly
/// orthonormal one, such as the identity or a quarter turn, is returned bit for bit.
///
/// A pose is accepted if its numbers are finite, its last row is 0 0 0 1, its rotation does not
/// mirror, rotation_error() is at most 1e-3, and its scale differs from 1 by at most 1e-5. The
/// scale is the factor that all directions share: a matrix has too large a scale if it lengthens
/// every vector by more than 1e-5 of it, and too small a scale if it shortens every vector so.
///
/// Cost: some 200 flops, no allocation. Source: the Newton iteration for the polar factor, N. J.
/// Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7(4), 1986, in the form
/// without an inverse, which converges quadratically from here.
[[nodiscard]] IST_API std::optional<Eigen::Isometry3d> project_to_rigid(
    const Eigen::Isometry3d& pose) noexcept;

/// Returns how far the rotation R of a pose is from orthonormal: the largest entry of |RᵀR - I|,
/// without a unit. 0 for the identity, infinity for numbers that are not finite. A product of n
/// rotations in float is some n · 1e-8 off. Cost: 20 ns.
[[nodiscard]] IST_API double rotation_error(const Eigen::Isometry3d& pose) noexcept;

/// Returns why project_to_rigid() refuses a pose, and the remedy, such as "it mirrors: give a
/// rotation, and mirror the mesh instead"; an empty text if it accepts the pose. The text is
/// static.
[[nodiscard]] IST_API const char* why_not_rigid(const Eigen::Isometry3d& pose) noexcept;

/// Returns the motion `second` after `first`, projected to a rigid motion, or nullopt if
/// project_to_rigid() returns it. For poses that accumulate many small motions: the result is rigid
/// to a few 1e-16, and rounding adds only a drift.
///
/// One composition turns the pose by at most 20u radians and moves it by at most 8u (|first| +
/// |second|), with u = 2⁻⁵³ and the lengths of both translations. So 10⁷ compositions turn it by at
/// most 2.3e-8 radians. Most roundings cancel: 4e-11 was measured.
///
/// The bits are the same on every instruction set and for any MXCSR of the caller. Cost: 0.1 µs.
[[nodiscard]] IST_API std::optional<Eigen::Isometry3d> compose_rigid(
    const Eigen::Isometry3d& second, const Eigen::Isometry3d& first) noexcept;

}  // namespace ist
