#pragma once

#include "ist/haptics/devices/device.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// Returns the largest stiffness K of a coupling with damping B that stays passive on a device of
/// physical damping b, in a loop of period T whose wrench acts `delay` t_d later:
///
///     b > K (T/2 + t_d) + |B|
///
/// K in N/m, B and b in N s/m, T and t_d in s; in rotation N m/rad and N m s/rad. 0 where b <= |B|.
/// Precondition: all finite, b and the delay at least 0, the period positive. docs/guarantees.md,
/// Stability border, derives it and gives the sources.
[[nodiscard]] double largest_stiffness(double damping, double coupling_damping, double period,
                                       double delay) noexcept;

/// The asked value of a setting, the largest value that the border allows, and the value in use.
struct BorderLimit {
  double asked, largest, used;
  [[nodiscard]] bool clamped() const noexcept { return used != asked; }
};

/// A coupling within the border, and the limits by which it was clamped.
struct ClampedCoupling {
  CouplingSettings settings;
  BorderLimit damping;            ///< N s/m
  BorderLimit stiffness;          ///< N/m
  BorderLimit angular_damping;    ///< N m s/rad
  BorderLimit angular_stiffness;  ///< N m/rad
  [[nodiscard]] bool clamped() const noexcept {
    return damping.clamped() || stiffness.clamped() || angular_damping.clamped() ||
           angular_stiffness.clamped();
  }
};

/// Clamps a coupling to the border: its damping to half of the device's, so that some is left for
/// stiffness, then its stiffness to 80 % of the largest with that damping; in rotation the same. On
/// a device without damping both become 0. Precondition: largest_stiffness's.
[[nodiscard]] ClampedCoupling clamp_coupling(const CouplingSettings& asked,
                                             const DeviceMechanics& device, double period) noexcept;

}  // namespace ist
