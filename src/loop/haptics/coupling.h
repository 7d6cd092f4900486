#pragma once

#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// The spring and damper between the device and the tool, in translation and rotation. The hand
/// feels nothing else, and the spring's force is bounded whatever the effects do.
///
/// The wrench on the tool is K · stretch + B · (rate of the stretch), and the opposite on the hand;
/// the stretch counts for at most max_force / K. Source: J. E. Colgate, M. C. Stanley and J. M.
/// Brown, Issues in the haptic display of tool use, IROS 1995.
class VirtualCoupling {
 public:
  explicit VirtualCoupling(const CouplingSettings& settings) : settings_(settings) {}

  /// The stretch at the beginning of a tick: metres, radians.
  struct Stretch {
    Vector6 length;  ///< from the tool to the device
    Vector6 device;  ///< the device's motion since the tick before
    double dt;       ///< s
  };
  /// The wrench on the tool after its `motion`, about its origin.
  [[nodiscard]] Vector6 wrench(const Stretch& stretch, const Vector6& motion) const noexcept;
  /// Adds that wrench and its stiffness to `response`. Turns are added, as small turns may be.
  void respond(const Stretch& stretch, const Vector6& motion, Response& response) const noexcept;

  [[nodiscard]] const CouplingSettings& settings() const noexcept { return settings_; }

 private:
  CouplingSettings settings_;
};

}  // namespace ist
