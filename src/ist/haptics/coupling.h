#pragma once

#include "ist/base/api.h"
#include "ist/haptics/effects/effect.h"

namespace ist {

/// What a scene's table `coupling` says.
struct CouplingSettings {
  double stiffness;          ///< K, N/m
  double damping;            ///< B, N s/m
  double angular_stiffness;  ///< N m/rad
  double angular_damping;    ///< N m s/rad
  double max_force;          ///< N: the spring is stretched no farther than gives this
  double max_torque;         ///< N m
};

/// The spring and damper between the device and the tool, in translation and in rotation. The hand
/// feels them and nothing else; its spring is bounded whatever the effects do.
///
/// On the tool acts K · stretch + B · (rate of the stretch), on the hand the opposite; the spring's
/// stretch counts for no more than max_force / K. Source: J. E. Colgate, M. C. Stanley and J. M.
/// Brown, Issues in the haptic display of tool use, IROS 1995.
class IST_API VirtualCoupling {
 public:
  explicit VirtualCoupling(const CouplingSettings& settings) : settings_(settings) {}

  /// What a tick begins with: metres, radians.
  struct Stretch {
    Vector6 length;  ///< from the tool to the device
    Vector6 device;  ///< how far the device went since the tick before
    double dt;       ///< s
  };
  /// The wrench on the tool after its `motion`, about its origin.
  [[nodiscard]] Vector6 wrench(const Stretch& stretch, const Vector6& motion) const noexcept;
  /// Adds it, and how it changes. Turns are added up, as small ones may be.
  void respond(const Stretch& stretch, const Vector6& motion, Response& response) const noexcept;

  [[nodiscard]] const CouplingSettings& settings() const noexcept { return settings_; }

 private:
  CouplingSettings settings_;
};

}  // namespace ist
