#pragma once

#include <filesystem>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/devices/plan.h"

namespace ist {

/// A hand that goes through a plan, whatever it should feel. Its time is the ticks' nominal one, so
/// that a run is the same on every machine.
class IST_API ScriptDevice final : public Device {
 public:
  /// Throws kInputInvalid where the waypoints are no plan (Plan).
  explicit ScriptDevice(std::vector<Waypoint> waypoints, const DeviceMechanics& mechanics = {});

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return mechanics_; }
  [[nodiscard]] std::optional<Placement> read() noexcept override { return plan_.at(time_).pose; }
  void write(const Vector6& /*wrench*/, double dt) noexcept override { time_ += dt; }
  /// Whether the last waypoint's time is past.
  [[nodiscard]] bool done() const noexcept override { return time_ > plan_.end(); }

 private:
  Plan plan_;
  DeviceMechanics mechanics_;
  double time_ = 0;
};

/// Reads waypoints from CSV: the header `time,x,y,z,qw,qx,qy,qz`, then a line for each waypoint.
/// Times in seconds start at 0 and ascend; `metres` are in the unit of x, y and z; quaternions may
/// have any length but 0. Blanks round a number and empty lines are passed over.
///
/// Throws kFileUnreadable, and kInputInvalid, naming file, line and remedy: for another header, a
/// line without eight finite numbers, a waypoint with a flaw (waypoint_flaw), a file without a
/// waypoint, and one of more than 64 MiB.
[[nodiscard]] IST_API std::vector<Waypoint> read_script(const std::filesystem::path& file,
                                                        double metres);

}  // namespace ist
