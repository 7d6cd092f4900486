#pragma once

#include <vector>

#include "haptics/effects/effect_case.h"
#include "ist/haptics/effects/friction_effect.h"

namespace ist::test {

inline constexpr double kPressStiffness = 1000;  // N/m, of the contact

/// A tool that is pressed on the plane whose normal is z, by points that stay where they are on it.
class PressedTool {
 public:
  /// Each of `feet`, in the tool's frame, carries its part of `load`, N.
  PressedTool(const FrictionSettings& settings, std::vector<Eigen::Vector3d> feet, double load)
      : contact_({kPressStiffness, 0.5}), friction_(settings, contact_), feet_(std::move(feet)) {
    press(load);
  }
  PressedTool(const PressedTool&) = delete;  // friction_ refers to contact_
  PressedTool& operator=(const PressedTool&) = delete;

  void press(double load) {
    load_ = load;
    at_.contacts.clear();
    for (const Eigen::Vector3d& foot : feet_) {
      const double each = load / (kPressStiffness * static_cast<double>(feet_.size()));
      at_.add_contact({at_.tool.rotation * foot, {0, 0, 1}, each, 1});
    }
  }
  void lift() { at_.contacts.clear(); }
  /// One tick. Returns the wrench at its end, as the law had it within the tick.
  Vector6 move(const Vector6& motion) {
    const Vector6 wrench = respond(friction_, at_, motion).wrench;
    const bool touches = !at_.contacts.points().empty();
    friction_.advance(at_.input(), motion);
    at_.tool = at_.tool.moved(motion);
    if (touches) press(load_);
    return wrench;
  }
  Vector6 slide(double x, double y = 0) { return move(six({x, y, 0}, {0, 0, 0})); }
  Vector6 turn(double angle) { return move(six({0, 0, 0}, {0, 0, angle})); }
  /// The wrench of a tick without motion.
  [[nodiscard]] Vector6 wrench() const { return respond(friction_, at_).wrench; }
  [[nodiscard]] const EffectCase& at() const { return at_; }
  [[nodiscard]] FrictionEffect& friction() { return friction_; }

 private:
  ContactEffect contact_;
  FrictionEffect friction_;
  std::vector<Eigen::Vector3d> feet_;
  EffectCase at_;
  double load_ = 0;
};

}  // namespace ist::test
