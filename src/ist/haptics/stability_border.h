#pragma once

#include "ist/base/api.h"
#include "ist/haptics/coupling.h"
#include "ist/haptics/devices/device.h"

namespace ist {

/// The largest stiffness K, N/m, of a coupling with damping B that stays passive on a device of
/// physical damping b, in a loop of the given period T whose wrench is felt `delay` t_d later:
///
///     b > K (T/2 + t_d) + |B|
///
/// N s/m and s; or N m/rad and N m s/rad. 0 where b <= |B|. Precondition: all finite, b and the
/// delay at least 0, the period positive.
///
/// Source: J. E. Colgate and G. G. Schenkel, Passivity of a class of sampled-data systems:
/// application to haptic interfaces, J. Robotic Systems 14(1), 1997, for no delay; with delay, T.
/// Hulin, A. Albu-Schäffer and G. Hirzinger, Passivity and stability boundaries for haptic systems
/// with time delay, IEEE Trans. Control Systems Technology, 2014 (doi 10.1109/TCST.2013.2283372).
/// For a delay of d periods it follows from the former's condition, b greater than the largest of
/// T/2 · Re{(1 - 1/z) H(z)}/(1 - cos wT) over |z| = 1: there a delayed spring gives K T/2 times
/// Dirichlet's kernel, whose largest value is 2d + 1, and a delayed damper -B cos((d + 1) wT).
[[nodiscard]] IST_API double largest_stiffness(double damping, double coupling_damping,
                                               double period, double delay) noexcept;

/// What a setting asked for, the largest value that the border allows, and what is used.
struct BorderLimit {
  double asked, largest, used;
  [[nodiscard]] bool clamped() const noexcept { return used != asked; }
};

/// A coupling within the border, and what had to give way.
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

/// First limits the coupling's damping to half of the device's, so that some is left for stiffness;
/// then the stiffness to 80 % of the largest with that damping. In rotation likewise. On a device
/// without damping nothing is left: both become 0. Precondition: largest_stiffness's.
[[nodiscard]] IST_API ClampedCoupling clamp_coupling(const CouplingSettings& asked,
                                                     const DeviceMechanics& device,
                                                     double period) noexcept;

}  // namespace ist
