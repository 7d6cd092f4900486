#include "ist/haptics/devices/device.h"

#include <utility>

#include "loop/haptics/devices/hand_device.h"
#include "loop/haptics/devices/script_device.h"

namespace ist {
namespace {

// A device that rests at one pose whatever the wrench, and never ends.
class NullDevice final : public Device {
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

}  // namespace

std::unique_ptr<Device> make_null_device(const Placement& pose, const DeviceMechanics& mechanics) {
  return std::make_unique<NullDevice>(pose, mechanics);
}

std::unique_ptr<Device> make_script_device(std::vector<Waypoint> plan,
                                           const DeviceMechanics& mechanics) {
  return std::make_unique<ScriptDevice>(std::move(plan), mechanics);
}

std::unique_ptr<Device> make_hand_device(HandSettings settings) {
  return std::make_unique<HandDevice>(std::move(settings));
}

}  // namespace ist
