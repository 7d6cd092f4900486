#include "loop/haptics/wrench_limiter.h"

#include <algorithm>
#include <cmath>

namespace ist {
namespace {

Eigen::Vector3d limited(const Eigen::Vector3d& v, double most) noexcept {
  const double largest = std::max(std::abs(v.x()), std::max(std::abs(v.y()), std::abs(v.z())));
  if (largest == 0) return v;
  // Scaled first, so that no square overflows.
  const Eigen::Vector3d scaled = v / largest;
  const double length = std::sqrt(scaled.squaredNorm());
  return largest * length <= most ? v : Eigen::Vector3d((most / length) * scaled);
}

Eigen::Vector3d passed(const Eigen::Vector3d& wanted, const Eigen::Vector3d& last, double gain,
                       double most, double most_change) noexcept {
  const Eigen::Vector3d target = gain * limited(wanted, most);
  const Eigen::Vector3d change = target - last;
  const Eigen::Vector3d allowed = limited(change, most_change);
  // An unlimited change returns the target itself, because the sum would be rounded.
  return allowed == change ? target : Eigen::Vector3d(last + allowed);
}

}  // namespace

Vector6 WrenchLimiter::limit(const Vector6& wanted, double dt) noexcept {
  if (!wanted.allFinite() || !(dt > 0) || !std::isfinite(dt)) return fault();
  good_ += dt;
  gain_ = good_ < settings_.soft_start ? good_ / settings_.soft_start : 1;
  const Eigen::Vector3d force = passed(wanted.head<3>(), last_.head<3>(), gain_,
                                       settings_.max_force, settings_.force_slew * dt);
  const Eigen::Vector3d torque = passed(wanted.tail<3>(), last_.tail<3>(), gain_,
                                        settings_.max_torque, settings_.torque_slew * dt);
  last_ << force, torque;
  return last_;
}

Vector6 WrenchLimiter::fault() noexcept {
  ++faults_;
  good_ = gain_ = 0;
  last_.setZero();
  return last_;
}

}  // namespace ist
