#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// The options of a ServoCallback.
struct ServoCallbackOptions {
  /// Metres in the unit of the poses' translations: 1, or 0.001 for millimetres. Forces are in N
  /// and torques in N m in any case.
  double unit = 1;
  /// Queries may search for this fraction of a tick, from the call on: above 0, at most 1.
  double query_time_fraction = 0.7;
  /// A limit of tests for each query of a tick, in place of the clock: equal forces in every run.
  std::optional<std::uint64_t> sphere_tests = std::nullopt;
};

/// The outcome of a tick.
enum class ServoTick {
  kFine,   ///< the contacts were complete
  kHeld,   ///< the contacts were incomplete: the tool is at its last complete pose
  kFault,  ///< the pose is not rigid, or a force is not finite: the force is zero
};

/// Makes ticks in the thread of a device's driver, which calls on_tick() with the device's pose
/// and sends the returned force to the motors. run_servo_loop() is the library's own loop.
///
/// Poses are 16 doubles in column-major order; they map the tool's frame to the scene's. The tool's
/// origin is the middle of the held body's box or the point that the scene names, its axes are the
/// held mesh's, and torques are about that origin.
///
/// Call on_tick() every Simulation::dt() seconds; each call counts as a tick of that length. One
/// thread calls at a time, but any thread may call last(). Scheduling the loop's thread for real
/// time is up to the caller.
class IST_API ServoCallback {
 public:
  /// A pose, in column-major order.
  using Pose = std::array<double, 16>;

  /// Counts of ticks since the object was made.
  struct Counts {
    std::uint64_t ticks = 0,  ///< all ticks, calls of fault() included
        held = 0,             ///< ticks with incomplete contacts
        faults = 0;           ///< ticks without a force
    std::uint64_t late = 0;   ///< ticks that took longer than Simulation::dt()
  };

  /// Throws kArgumentInvalid for a unit that is not positive and finite, or a query_time_fraction
  /// outside (0, 1].
  /// @param simulation must outlive the object; no one else may make its ticks
  /// @param options    unit and limits of the queries
  explicit ServoCallback(Simulation& simulation, const ServoCallbackOptions& options = {});

  /// Makes one tick.
  ///
  /// @param pose   the device's pose: the coupling draws the tool to it
  /// @param force  receives the force on the hand, N, scene axes; zero at a fault
  /// @param torque receives the torque on the hand, N m; zero at a fault
  ///
  /// Allocates nothing, locks nothing and makes no system call. The result does not depend on the
  /// caller's rounding mode. Cost: Simulation::tick(), and 0.5 µs to publish the record of last().
  ServoTick on_tick(std::span<const double, 16> pose, std::span<double, 3> force,
                    std::span<double, 3> torque) noexcept;

  /// As Simulation::attach(), with the limits of a tick. Between ticks.
  [[nodiscard]] ChangeStatus attach(std::size_t body) noexcept;
  /// As Simulation::release(), with the limits of a tick. Between ticks.
  [[nodiscard]] ChangeStatus release(std::size_t body) noexcept;

  /// Counts a tick as a fault, for a caller that has no valid pose. Set the force to zero; it
  /// returns through the soft start.
  void fault() noexcept;

  /// Returns the record of the last tick: poses, wrench, contacts and times. SI, whatever the unit
  /// of the poses. `late_ns` and `cpu_ns` are 0.
  ///
  /// Any thread may call it at any time, also while another thread is in on_tick(). The loop never
  /// waits for a reader. Empty before the first tick, and if the loop was writing during every
  /// attempt: ask again later. Allocates nothing, locks nothing and makes no system call. Cost: 0.2
  /// µs, or up to 10 µs if the loop is writing.
  [[nodiscard]] std::optional<TickRecord> last() const noexcept;

  /// The tool's pose in the poses' unit: before the first tick the start pose for the device, later
  /// the pose to draw, which stays outside the fixed body.
  [[nodiscard]] Pose tool() const noexcept;
  /// Metres in the poses' unit.
  [[nodiscard]] double unit() const noexcept { return options_.unit; }
  /// The counts so far.
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] Budget budget_from(Budget::Clock::time_point begin) const noexcept;
  void publish(const Tick& tick, bool device_known, Budget::Clock::time_point begin) noexcept;

  Simulation& simulation_;
  ServoCallbackOptions options_;
  std::chrono::nanoseconds period_, query_time_;
  Counts counts_;
  Placement device_;  // the last that was known
  Snapshot<std::optional<TickRecord>> last_;
};

}  // namespace ist
