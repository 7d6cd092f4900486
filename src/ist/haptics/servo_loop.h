#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/latency_histogram.h"
#include "ist/haptics/real_time.h"
#include "ist/haptics/simulation.h"
#include "ist/haptics/snapshot.h"
#include "ist/haptics/tick_record.h"
#include "ist/haptics/tick_ring.h"

namespace ist {

struct ServoOptions {
  std::uint64_t ticks;  ///< it ends after so many, those that were missed included
  /// By the clock, one a period; else one after the other without a look at it, and only budgets in
  /// tests count.
  bool paced = true;
  /// Part of the period in which queries may still begin anything, from the tick's release on.
  double query_share = 0.7;
  RealTimeOptions real_time;
};

/// Where ticks go; each may be null.
struct ServoOutputs {
  /// Every tick. A paced loop loses those that find it full, another one waits.
  TickRing<TickRecord>* records = nullptr;
  Snapshot<TickRecord>* snapshot = nullptr;  ///< the last tick, for whoever looks
  Progress* progress = nullptr;              ///< ticks that are done, of ServoOptions::ticks
};

/// What a run of the loop came to.
struct ServoReport {
  LatencyHistogram late;  ///< release jitter: from when a tick should have begun to when it did
  LatencyHistogram execution;  ///< from then until the device was told
  LatencyHistogram cpu;        ///< what the loop's thread used of its processor
  /// The tick that used most of the processor: that, and what the effects took of it.
  std::chrono::nanoseconds worst_cpu{}, worst_effects{};
  std::uint64_t ticks = 0;   ///< that were made
  std::uint64_t missed = 0;  ///< ended after their period, or were left out for one that did
  std::uint64_t held = 0;    ///< whose answer was not complete
  std::uint64_t faults = 0;
  std::uint64_t lost_records = 0;
  std::vector<std::string> notes;  ///< what the system did not permit
};

/// The servo loop: reads the device, turns the simulation by one tick, and tells the device what to
/// feel, once a period. At the end, and where `stop` is set, the device is told to rest.
///
/// Runs in the calling thread, as RealTimeThread has it. A tick allocates nothing, locks nothing
/// and waits for no one; its only system calls are those that sleep and read its thread's clock.
[[nodiscard]] IST_API ServoReport run_servo_loop(Simulation& simulation, Device& device,
                                                 const ServoOptions& options,
                                                 const ServoOutputs& outputs,
                                                 const std::atomic<bool>& stop);

}  // namespace ist
