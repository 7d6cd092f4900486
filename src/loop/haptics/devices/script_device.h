#pragma once

#include <vector>

#include "ist/haptics/devices/device.h"
#include "loop/haptics/devices/plan.h"

namespace ist {

/// A device that follows a plan whatever the wrench (make_script_device).
class ScriptDevice final : public Device {
 public:
  /// Throws kArgumentInvalid if the waypoints are no plan (Plan).
  explicit ScriptDevice(std::vector<Waypoint> waypoints, const DeviceMechanics& mechanics = {});

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return mechanics_; }
  [[nodiscard]] std::optional<Placement> read() noexcept override;
  void write(const Vector6& wrench, double dt) noexcept override;
  /// Whether the time of the last waypoint has passed.
  [[nodiscard]] bool done() const noexcept override { return time_ > plan_.end(); }

 private:
  Plan plan_;
  DeviceMechanics mechanics_;
  double time_ = 0;
};

}  // namespace ist
