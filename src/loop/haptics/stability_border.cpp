#include "loop/haptics/stability_border.h"

#include <algorithm>
#include <cmath>

namespace ist {
namespace {

constexpr double kDampingFraction = 0.5;
constexpr double kStiffnessFraction = 0.8;

BorderLimit limit_damping(double asked, double device_damping) noexcept {
  const double largest = kDampingFraction * device_damping;
  return {asked, largest, std::clamp(asked, -largest, largest)};
}

BorderLimit limit_stiffness(double asked, double largest) noexcept {
  return {asked, largest, std::min(asked, kStiffnessFraction * largest)};
}

}  // namespace

double largest_stiffness(double damping, double coupling_damping, double period,
                         double delay) noexcept {
  return std::max(0.0, damping - std::abs(coupling_damping)) / (0.5 * period + delay);
}

ClampedCoupling clamp_coupling(const CouplingSettings& asked, const DeviceMechanics& device,
                               double period) noexcept {
  const BorderLimit damping = limit_damping(asked.damping, device.damping);
  const BorderLimit stiffness = limit_stiffness(
      asked.stiffness, largest_stiffness(device.damping, damping.used, period, device.delay));
  const BorderLimit angular_damping = limit_damping(asked.angular_damping, device.angular_damping);
  const BorderLimit angular_stiffness = limit_stiffness(
      asked.angular_stiffness,
      largest_stiffness(device.angular_damping, angular_damping.used, period, device.delay));
  CouplingSettings settings = asked;
  settings.damping = damping.used;
  settings.stiffness = stiffness.used;
  settings.angular_damping = angular_damping.used;
  settings.angular_stiffness = angular_stiffness.used;
  return {settings, damping, stiffness, angular_damping, angular_stiffness};
}

}  // namespace ist
