#include "loop/haptics/coupling.h"

#include <cmath>

namespace ist {
namespace {

// The fraction of a spring's stiffness that keeps its force at `most` or below.
double part_of(double stiffness, double most, const Eigen::Vector3d& stretch) noexcept {
  const double force = stiffness * std::sqrt(stretch.squaredNorm());
  return force > most ? most / force : 1;
}

struct Parts {
  double translation, rotation;
};

Parts parts_of(const CouplingSettings& settings, const Vector6& length) noexcept {
  return {part_of(settings.stiffness, settings.max_force, length.head<3>()),
          part_of(settings.angular_stiffness, settings.max_torque, length.tail<3>())};
}

}  // namespace

Vector6 VirtualCoupling::wrench(const Stretch& stretch, const Vector6& motion) const noexcept {
  const Vector6 length = stretch.length - motion;
  const Vector6 rate = (stretch.device - motion) / stretch.dt;
  const Parts parts = parts_of(settings_, length);
  Vector6 wrench;
  wrench.head<3>() = (settings_.stiffness * parts.translation) * length.head<3>() +
                     settings_.damping * rate.head<3>();
  wrench.tail<3>() = (settings_.angular_stiffness * parts.rotation) * length.tail<3>() +
                     settings_.angular_damping * rate.tail<3>();
  return wrench;
}

void VirtualCoupling::respond(const Stretch& stretch, const Vector6& motion,
                              Response& response) const noexcept {
  const Parts parts = parts_of(settings_, stretch.length - motion);
  response.wrench += wrench(stretch, motion);
  response.stiffness.diagonal().head<3>().array() +=
      settings_.stiffness * parts.translation + settings_.damping / stretch.dt;
  response.stiffness.diagonal().tail<3>().array() +=
      settings_.angular_stiffness * parts.rotation + settings_.angular_damping / stretch.dt;
}

}  // namespace ist
