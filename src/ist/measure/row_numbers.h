#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "ist/base/api.h"
#include "ist/measure/pose_rows.h"

namespace ist {

/// The answers at one pose as numbers, for tables. If a number was not asked for, or the pose is
/// invalid, an integer is 0 and a double is NaN.
struct RowNumbers {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  bool pose_is_valid = true;
  /// Of Answer; kUnknown where nothing was asked.
  std::int32_t intersects = 0;
  bool complete = false;        ///< every search ended and every tolerance was reached
  std::int32_t not_closed = 0;  ///< 0: both bodies are; 1: the fixed one is not; 2: the moving one
  std::int32_t self_intersecting = 0;  ///< of a depth: self_intersecting_code()
  bool capped = false;                 ///< of a depth: Penetration::capped
  std::uint64_t leaf_pairs = 0;
  std::uint64_t sphere_tests = 0;  ///< of all searches, those of a depth excepted
  double distance_lower = kNone, distance_upper = kNone;
  double depth_lower = kNone, depth_upper = kNone;
  double area = kNone;  ///< mesh units²
  Eigen::Vector3d force = Eigen::Vector3d::Constant(kNone),
                  torque = Eigen::Vector3d::Constant(kNone);  ///< of springs of `stiffness`
  double rotation_error = 0;  ///< of the given pose, also of an invalid one
};

/// Returns the numbers of a row.
/// @param stiffness of springs, N/mm³ where meshes are in mm
[[nodiscard]] IST_LOOP_API RowNumbers numbers_of(const PoseRow& row, double stiffness);

/// Returns the code of `not_closed` for a depth.
[[nodiscard]] std::int32_t not_closed_code(const Penetration& found) noexcept;

/// Returns 1 if the fixed body's surface intersects itself, 2 if the moving body's does, their sum,
/// or 0.
template <class Found>
[[nodiscard]] std::int32_t self_intersecting_code(const Found& found) noexcept {
  return (found.fixed_self_intersecting ? 1 : 0) + (found.moving_self_intersecting ? 2 : 0);
}

}  // namespace ist
