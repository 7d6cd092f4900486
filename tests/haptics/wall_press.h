#pragma once

#include <memory>

#include "ist/haptics/placement.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// The pair of a press: two bodies in millimetres, in voxels of 0.5, that meet when the held one
/// goes along `way`. Numbers of a press on it are in m, N/m, N s/m and N, or where it turns in rad,
/// N m/rad, N m s/rad and N m.
struct Wall {
  std::unique_ptr<const SphereTree> fixed, held;
  bool turns;
  Vector6 way;   ///< of unit length
  double reach;  ///< of the hand's plan along it, from the pose as made to within the wall
  double contact_stiffness;  ///< of the springs, N/m
  double margin = 0.5;       ///< of the springs, voxels
  double full_area = 10;     ///< of the springs, leaf pairs
};
/// A block over a slab, 1 mm apart, stiffer than any coupling: it stops a push along -z.
[[nodiscard]] Wall slab_wall();
/// A pair of balls, one over and one under a slab: it stops a turn about y and nothing else.
[[nodiscard]] Wall stop_wall();
/// A ball of two voxels over a slab, with the springs of a scene that names no number. Where they
/// meet, leaf pairs come and gain weight within a fifth of a voxel.
[[nodiscard]] Wall tip_wall();

struct PressSettings {
  double rate = 1000;           ///< ticks a second
  double delay = 0;             ///< of the device, s
  double damping = 2;           ///< the device's own: b
  double stiffness = 1000;      ///< the coupling's: K
  double coupling_damping = 0;  ///< B
  double resolution = 0;        ///< of the encoders: q
};

struct PressResult {
  /// Energy that the hand got while the bodies touched, less that of the device's damping, J.
  /// Where it is positive the wall is active: a hand that does the same again and again draws
  /// energy from it without end.
  double returned;
  /// The part of it that is due to encoders and to the tick in which bodies meet, at most, J:
  ///
  ///     (K/2 + |B|/T) q · way gone in contact  +  (K T + |B|) T v²
  ///
  /// A reading is within q/2 of where the hand is, but for a shift of q/2 that moves the whole
  /// wall, and so the force within K q/2 of one that comes from a potential, and a rate within q/T.
  /// Bodies that meet within a tick, first at a speed v, are known to touch in the next: for v T of
  /// the way the wall is not there. The hand itself is integrated without error (HandDevice).
  double allowance;
  /// The fastest motion late in the hold, as a part of the fastest early in it: above 1 it grows.
  double growth;
  double most_felt;  ///< N or N m along the wall's way

  [[nodiscard]] bool active() const noexcept { return returned > allowance; }
};

/// A hand comes, presses, holds, goes away: 0.8 s, in which nothing clamps the coupling. Its arm is
/// a spring without damping, so that only the device's own is there to pay for what the loop gives.
/// Deterministic; there is no clock.
[[nodiscard]] PressResult press(const Wall& wall, const PressSettings& settings);

/// The least stiffness, to 2 %, with which a press is active: between half and four times
/// `about`; the latter where none is.
[[nodiscard]] double measured_border(const Wall& wall, PressSettings settings, double about);

}  // namespace ist::test
