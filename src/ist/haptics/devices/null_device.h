#pragma once

#include "ist/base/api.h"
#include "ist/haptics/devices/device.h"

namespace ist {

/// Nobody's hand: it stays where it is, whatever it should feel, and never comes to an end.
class IST_API NullDevice final : public Device {
 public:
  explicit NullDevice(const Placement& pose, const DeviceMechanics& mechanics = {})
      : pose_(pose), mechanics_(mechanics) {}

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return mechanics_; }
  [[nodiscard]] std::optional<Placement> read() noexcept override { return pose_; }
  void write(const Vector6& /*wrench*/, double /*dt*/) noexcept override {}

 private:
  Placement pose_;
  DeviceMechanics mechanics_;
};

}  // namespace ist
