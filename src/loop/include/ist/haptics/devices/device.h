#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"

namespace ist {

/// The mechanics of a device, by which the coupling is kept stable.
struct DeviceMechanics {
  double damping = 0;          ///< b: physical damping of the device alone, N s/m
  double angular_damping = 0;  ///< N m s/rad
  double delay = 0;            ///< from write() until the hand feels the wrench, s
};

/// A haptic device. The servo loop calls read() and then write() once a tick, in one thread.
/// Neither function may allocate, lock or throw.
class IST_API Device {
 public:
  virtual ~Device() = default;
  /// Damping and delay, the same in every call.
  [[nodiscard]] virtual DeviceMechanics mechanics() const noexcept = 0;

  /// Reads the pose of the device at the beginning of a tick; the coupling draws the tool there.
  /// Empty if the device does not know its pose.
  [[nodiscard]] virtual std::optional<Placement> read() noexcept = 0;
  /// Sets the wrench on the hand, about the tool's origin: N and N m, scene axes. A tick of `dt`
  /// seconds begins.
  virtual void write(const Vector6& wrench, double dt) noexcept = 0;
  /// Whether the device has come to the end of its motion.
  [[nodiscard]] virtual bool done() const noexcept { return false; }
};

/// A pose of a plan. Times ascend from 0; from one waypoint to the next the turn is a third of a
/// circle at most.
struct Waypoint {
  double time = 0;      ///< s
  Placement pose = {};  ///< of the device at that time
};

/// A simulated operator who moves a device along a plan. By default an arm that holds a stylus
/// lightly: with the device's damping it swings at 8 Hz, damped to 0.6 of critical; its turn at
/// 11 Hz, to 0.8.
struct HandSettings {
  /// By which the coupling is kept stable.
  DeviceMechanics mechanics = {.damping = 2, .angular_damping = 2e-3};
  double mass = 0.2;                  ///< of device and arm, kg
  double inertia = 2e-4;              ///< about every axis, kg m²
  double arm_stiffness = 500;         ///< of the spring from the plan to the device, N/m
  double arm_damping = 10;            ///< N s/m
  double arm_angular_stiffness = 1;   ///< N m/rad
  double arm_angular_damping = 0.02;  ///< N m s/rad
  double resolution = 0;              ///< of the encoders, m; 0: exact
  double angular_resolution = 0;      ///< rad; 0: exact
  std::vector<Waypoint> plan = {};    ///< at least one waypoint
};

/// Makes a device that rests at `pose` and never ends.
[[nodiscard]] IST_API std::unique_ptr<Device> make_null_device(
    const Placement& pose, const DeviceMechanics& mechanics = {});

/// Makes a device that follows `plan` whatever the wrench. Its time is the sum of the ticks' `dt`,
/// so that a run is the same on every machine. Throws kArgumentInvalid, naming the waypoint, for a
/// bad plan.
[[nodiscard]] IST_API std::unique_ptr<Device> make_script_device(
    std::vector<Waypoint> plan, const DeviceMechanics& mechanics = {});

/// Makes a simulated operator. Throws kArgumentInvalid for a mass or inertia that is not positive,
/// a number that is negative or not finite, a delay above 10 ms, and a bad plan.
[[nodiscard]] IST_API std::unique_ptr<Device> make_hand_device(HandSettings settings);

/// Reads a plan from CSV: the header `time,x,y,z,qw,qx,qy,qz`, then one line for each waypoint.
/// Times are in seconds; `metres` are in the unit of x, y and z; a quaternion has any length but 0.
/// Blanks and empty lines are ignored.
///
/// Throws kFileUnreadable; kInputInvalid, naming file, line and remedy, for another header, a line
/// without eight finite numbers, a bad waypoint, a file without waypoints or of more than 64 MiB;
/// kArgumentInvalid if `metres` is not positive and finite.
[[nodiscard]] IST_API std::vector<Waypoint> read_script(const std::filesystem::path& file,
                                                        double metres);

}  // namespace ist
