#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ist/haptics/devices/device.h"
#include "ist/haptics/placement.h"
#include "ist/haptics/simulation.h"
#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// The most that a step of a constraint moves the tool near a wall, and the most steps of a tick.
inline constexpr double kPressTrust = 20e-6;  // m
inline constexpr int kPressSteps = 3;

/// How a wall stops the tool: by springs of leaf pairs, or by a constraint.
enum class Stop { kSprings, kConstraint };

/// The pair of a press: two bodies in millimetres, in voxels of 0.5, that meet when the held one
/// goes along `way`. Numbers of a press on it are in m, N/m, N s/m and N. If it turns they are in
/// rad, N m/rad, N m s/rad and N m.
struct PressedWall {
  struct Springs {
    double stiffness;       ///< N/m
    double margin = 0.5;    ///< voxels
    double full_area = 10;  ///< leaf pairs
  };

  std::unique_ptr<const SphereTree> fixed, held;
  bool turns;
  Vector6 way;   ///< of unit length
  double reach;  ///< of the hand's plan along it, from the pose as made to within the wall
  std::optional<Springs> springs;  ///< none: a constraint
};
/// A block over a slab, 1 mm apart, stiffer than any coupling: it stops a push along -z.
[[nodiscard]] PressedWall slab_wall(Stop stop);
/// A pair of balls, one over and one under a slab: it stops a turn about y and nothing else.
[[nodiscard]] PressedWall stop_wall(Stop stop);
/// A ball of two voxels over a slab, with the springs of a scene that names no number. Leaf pairs
/// come and gain weight within a fifth of a voxel after the first touch.
[[nodiscard]] PressedWall tip_wall(Stop stop);
/// A constraint: the edge of a block, turned by 45 degrees, across the edge of another one, 1 mm
/// apart.
[[nodiscard]] PressedWall edge_wall();

struct PressSettings {
  double rate = 1000;           ///< ticks a second
  double delay = 0;             ///< of the device, s
  double damping = 2;           ///< the device's own: b
  double stiffness = 1000;      ///< the coupling's: K
  double coupling_damping = 0;  ///< B
  double resolution = 0;        ///< of the encoders: q
  double hold = 0.35;           ///< time of the press, s
  double friction = 0;          ///< of a constraint
  double contact_damping = 0;   ///< of a constraint, N s/m
};

/// The energy that the wrench gave the hand, J, and the leaks from which it may come. A constraint
/// with a coupling without damping gives no more than the sum of the leaks, over any path that ends
/// as it began. |d| is the device's way of a tick in the metric of the coupling: |d|² = K |v|² +
/// K_r |r|².
struct Energy {
  double work = 0;        ///< of the wrench on the hand
  double sampled = 0;     ///< Σ |d|² / 2: the force is held while the device moves
  double delayed = 0;     ///< Σ |d| |way of the device in the delay before|
  double asked_back = 0;  ///< Σ force · (skin - gap) of contacts whose gap is too narrow
  /// Σ q/2 (way of the device + way of the tool): a reading is within q/2 of the hand, on each
  /// axis, but for a shift of q/2 of the whole wall.
  double feigned = 0;

  [[nodiscard]] double leaks() const noexcept { return sampled + delayed + asked_back + feigned; }
};

struct PressResult {
  /// Energy that the hand got while the bodies touched, less that of the device's damping, J.
  /// If it is positive the wall is active: a hand that does the same again and again draws energy
  /// from it without end.
  double returned;
  /// The part of it that is due to encoders, to the tick in which bodies meet, and to gaps that are
  /// asked back, at most, J:
  ///
  ///     (K/2 + |B|/T) q · way gone in contact  +  (K T + |B|) T v²  +  Σ force · (skin - gap)
  ///
  /// A reading is within q/2 of the hand, but for a shift of q/2 that moves the whole wall, and so
  /// the force within K q/2 of one that comes from a potential, and a rate within q/T. Bodies that
  /// meet within a tick, first at a speed v, push each other from the next tick on if the wall is
  /// of springs: for v T of the way the wall is not there. The K of that term is 0 for a
  /// constraint. The last term is 0 for springs. The hand is integrated without error (HandDevice).
  double allowance;
  Energy energy;           ///< of the whole run
  double early, late;      ///< the fastest motion early and late in the hold, m/s or rad/s
  double most_felt;        ///< N or N m along the wall's way
  std::uint64_t touching;  ///< ticks with contacts

  /// Above 1 the motion in the hold grows.
  [[nodiscard]] double growth() const noexcept { return late / early; }
  [[nodiscard]] bool active() const noexcept { return returned > allowance; }
};

/// The simulation of a press. The tool is at press_start().
[[nodiscard]] Simulation press_simulation(const PressedWall& wall, const PressSettings& settings);
[[nodiscard]] Placement press_start(const PressedWall& wall);

/// A hand comes, presses, holds, goes away: 0.45 s and the hold, in which nothing clamps the
/// coupling. Its arm is a spring without damping, so that only the device's own is there to pay for
/// the energy that the loop gives. Deterministic; there is no clock.
[[nodiscard]] PressResult press(const PressedWall& wall, const PressSettings& settings);

/// The same hand goes from pose to pose, each so far from the start (Placement::moved), and then
/// back. A pose takes `seconds`.
[[nodiscard]] PressResult wander(const PressedWall& wall, const PressSettings& settings,
                                 const std::vector<Vector6>& poses, double seconds);

/// The least stiffness, to 2 %, with which a press is active: between half and four times
/// `about`; the latter if none is.
[[nodiscard]] double measured_border(const PressedWall& wall, PressSettings settings, double about);

}  // namespace ist::test
