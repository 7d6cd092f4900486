#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/haptics/simulation.h"

namespace ist {

struct ServoCallbackOptions {
  /// Metres in the unit of the poses' translations: 1, or 0.001 for a device that speaks
  /// millimetres. Forces are in N and torques in N m all the same.
  double unit = 1;
  /// Part of the tick's length in which queries may still begin anything, from the call on.
  double query_share = 0.7;
  /// What each of a tick's queries may spend instead, by no clock: the same forces in every run.
  std::optional<std::uint64_t> sphere_tests = std::nullopt;
};

/// How a tick went.
enum class ServoTick {
  kFine,   ///< all was known
  kHeld,   ///< not enough time for all contacts: the tool is where they were last known
  kFault,  ///< a pose that is no rigid motion, or forces that are no numbers: nothing is felt
};

/// For a loop that is not ours: a device's own thread, which brings where its handle is once a
/// tick and takes along what the hand is to feel. run_servo_loop() is the loop that is ours.
///
/// Poses are plain doubles, column by column, so that who calls needs no Eigen: they map the tool's
/// own frame to the scene's. The tool's origin is the centre of the held body's grid, its axes are
/// the held mesh's, and all torques are about that origin.
///
/// A call should come every Simulation::dt() seconds, which is what a tick counts as, however late
/// it comes. Calls belong to one thread at a time. Setting up that thread for real time, and to
/// call in time, is the device's.
class IST_API ServoCallback {
 public:
  using Pose = std::array<double, 16>;

  struct Counts {
    std::uint64_t ticks = 0, held = 0, faults = 0;
    std::uint64_t late = 0;  ///< took longer than a tick has
  };

  /// Throws kInputInvalid for a unit that is no positive number, or a share outside (0, 1].
  /// @param simulation outlives this object, and is turned by it alone
  ServoCallback(Simulation& simulation, const ServoCallbackOptions& options);

  /// One tick.
  ///
  /// @param pose   where the device is; it draws the tool there
  /// @param force  takes what the hand is to feel, N, scene axes; zero at a fault
  /// @param torque likewise, N m
  ///
  /// Allocates nothing, locks nothing, makes no system call, and whatever the caller's arithmetic
  /// is gives the same bits. Cost: Simulation::tick().
  ServoTick on_tick(std::span<const double, 16> pose, std::span<double, 3> force,
                    std::span<double, 3> torque) noexcept;

  /// For who calls and knows that something is wrong: counts as a tick that was a fault. Nothing is
  /// to be felt, and forces come back softly.
  void fault() noexcept;

  /// Where the tool is, in the poses' unit: to begin with where a device should be, and after a
  /// tick what is to be drawn, for it stays outside where the device goes in.
  [[nodiscard]] Pose tool() const noexcept;
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  Simulation& simulation_;
  ServoCallbackOptions options_;
  Budget::Clock::duration period_, query_time_;
  Counts counts_;
};

}  // namespace ist
