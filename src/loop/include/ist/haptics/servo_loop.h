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
#include "ist/haptics/recording.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// Requests of a paced loop to the system. A denied request is noted in ServoReport::notes, and the
/// loop runs without it.
struct RealTimeOptions {
  int priority = 80;                      ///< under SCHED_FIFO, 1 to 99
  std::optional<int> cpu = std::nullopt;  ///< pins the loop to this processor, counted from 0
  bool lock_memory = true;                ///< locks all memory of the process (mlockall)
};

/// The options of run_servo_loop().
struct ServoOptions {
  std::uint64_t ticks = 0;  ///< the number of ticks, missed ones included
  /// Makes one tick each period. If false, ticks follow each other without a clock, and queries
  /// have no deadline.
  bool paced = true;
  /// The fraction of a period for queries, from the tick's release on: above 0, at most 1.
  double query_time_fraction = 0.7;
  RealTimeOptions real_time = {};  ///< of a paced loop
};

/// Takes the ticks of a loop in the loop's thread, between ticks.
class TickReceiver {
 public:
  virtual ~TickReceiver() = default;
  /// Takes a tick. Must neither allocate nor wait.
  virtual void take(const TickRecord& record) noexcept = 0;
};

/// The receivers of ticks; each may be null.
struct ServoOutputs {
  /// Every tick. If the ring is full, a paced loop drops the record; an unpaced one waits.
  TickRing<TickRecord>* records = nullptr;
  Snapshot<TickRecord>* snapshot = nullptr;  ///< the last tick
  TickReceiver* receiver = nullptr;          ///< every tick
  Progress* progress = nullptr;              ///< ticks done, of ServoOptions::ticks
};

/// The statistics of a run.
struct ServoReport {
  LatencyHistogram late;                 ///< release jitter: from a tick's release to its start
  LatencyHistogram execution;            ///< from its start to the end of Device::write
  LatencyHistogram cpu;                  ///< processor time of the loop's thread
  std::chrono::nanoseconds worst_cpu{},  ///< the largest processor time of a tick
      worst_effects{};                   ///< the time of the effects in that tick
  std::uint64_t ticks = 0;               ///< ticks made
  std::uint64_t missed = 0;              ///< ticks that ended after their period, or were skipped
  std::uint64_t held = 0;                ///< Tick::held
  std::uint64_t halved = 0;              ///< Tick::halved
  std::uint64_t steps = 0;               ///< Tick::steps, in all ticks
  std::uint64_t in_contact = 0;          ///< ticks with contacts that pushed the tool
  std::uint32_t most_points = 0;         ///< the most contacts that pushed in a tick
  double largest_point_force = 0;        ///< the largest force of one contact, N
  std::uint64_t faults = 0;              ///< ticks without a force: Tick::fault
  std::uint64_t fresh = 0,               ///< ticks whose contacts were found by a search
      kept = 0,                          ///< among the leaf pairs kept from earlier ticks
      clear = 0;                         ///< inside a clearance
  std::uint64_t lost_records = 0;        ///< records that found the ring full
  std::vector<std::string> notes;        ///< denied requests to the system, with cause and remedy
};

/// Runs the servo loop in the calling thread: once a period it reads the device, makes a tick and
/// writes the wrench to the device. Returns after ServoOptions::ticks, when the device is done, or
/// after `stop` is set; the last write to the device is a zero wrench.
///
/// A tick allocates nothing and locks nothing; its only system calls sleep and read the thread's
/// clock. Threads that the loop's thread starts meanwhile inherit its scheduling. Throws
/// kArgumentInvalid for a query_time_fraction outside (0, 1]; std::bad_alloc.
[[nodiscard]] IST_API ServoReport run_servo_loop(Simulation& simulation, Device& device,
                                                 const ServoOptions& options,
                                                 const ServoOutputs& outputs,
                                                 const std::atomic<bool>& stop);

}  // namespace ist
