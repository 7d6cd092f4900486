#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "ist/base/api.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// A tick as it leaves the loop: plain numbers, to be copied word by word. SI, scene axes.
struct TickRecord {
  /// Translation, then the rotation column by column.
  using Pose = std::array<double, 12>;

  std::uint64_t tick;  ///< from 0; numbers that are left out are ticks that were missed
  double dt;           ///< the tick's nominal length, s
  Pose device, tool;
  std::array<double, 6> wrench;
  bool device_known, fault, held;
  std::optional<QueryResult> contacts, proximity;  ///< mesh units
  double leaf_pairs;
  std::int64_t late_ns;       ///< from when the tick should have begun
  std::int64_t execution_ns;  ///< from when it began to when the device was told
  std::int64_t cpu_ns;        ///< that the loop's thread used of its processor meanwhile
};

/// Without its times.
[[nodiscard]] IST_API TickRecord record_of(std::uint64_t number, double dt, const Tick& tick,
                                           bool device_known) noexcept;

[[nodiscard]] IST_API TickRecord::Pose to_numbers(const Placement& placement) noexcept;
/// Nothing where the numbers are no rigid motion; a rotation that is orthonormal to a few 1e-16
/// comes back bit for bit.
[[nodiscard]] IST_API std::optional<Placement> to_placement(
    const TickRecord::Pose& numbers) noexcept;

/// A tick of a recording, to be made again.
struct RecordedTick {
  std::uint64_t tick;
  std::optional<Placement> device;
  TickBudget budget;  ///< in tests: where the queries stopped, or that they came to an end
};

/// Makes it again: the same record but for its times, if all ticks before it were made again.
[[nodiscard]] IST_API TickRecord replay(const RecordedTick& recorded,
                                        Simulation& simulation) noexcept;

}  // namespace ist
