#pragma once

#include <optional>

#include "ist/base/api.h"
#include "ist/haptics/placement.h"

namespace ist {

/// What is known of a device's mechanics.
struct DeviceMechanics {
  double damping = 0;          ///< physical, of the device alone, N s/m: b
  double angular_damping = 0;  ///< N m s/rad
  double delay = 0;            ///< from a wrench that is written to the force that is felt, s
};

/// What a hand holds. It is asked once a tick where it wants the tool, and told once what to feel.
/// Neither function allocates, locks or throws.
class IST_API Device {
 public:
  virtual ~Device() = default;
  [[nodiscard]] virtual DeviceMechanics mechanics() const noexcept = 0;

  /// Where the device is at the beginning of a tick, as its encoders tell: the tool is drawn there.
  /// Nothing where it cannot tell.
  [[nodiscard]] virtual std::optional<Placement> read() noexcept = 0;
  /// What the hand feels from now on, about the tool's origin: N and N m, axes of the scene. A tick
  /// of `dt` seconds begins.
  virtual void write(const Vector6& wrench, double dt) noexcept = 0;
  /// Whether it has come to the end of what it does.
  [[nodiscard]] virtual bool done() const noexcept { return false; }
};

}  // namespace ist
