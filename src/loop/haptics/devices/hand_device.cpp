#include "loop/haptics/devices/hand_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ist/base/float_environment.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

constexpr double kLongestStep = 20e-6;  // s
constexpr int kFewestSteps = 16;        // a tick

void check(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw_error(ErrorCode::kArgumentInvalid, "HandSettings: {} is {}: give a number from {} to {}",
              name, value, least, most);
}

HandSettings checked(HandSettings settings) {
  constexpr double kLeast = 1e-9, kMost = 1e9;
  check("mass", settings.mass, kLeast, kMost);
  check("inertia", settings.inertia, kLeast, kMost);
  check("damping", settings.mechanics.damping, 0, kMost);
  check("angular_damping", settings.mechanics.angular_damping, 0, kMost);
  check("delay", settings.mechanics.delay, 0, HandDevice::kLongestDelay);
  check("arm_stiffness", settings.arm_stiffness, 0, kMost);
  check("arm_damping", settings.arm_damping, 0, kMost);
  check("arm_angular_stiffness", settings.arm_angular_stiffness, 0, kMost);
  check("arm_angular_damping", settings.arm_angular_damping, 0, kMost);
  check("resolution", settings.resolution, 0, kMost);
  check("angular_resolution", settings.angular_resolution, 0, kMost);
  return settings;
}

// One degree of freedom: translation or rotation.
struct Oscillator {
  double mass, stiffness, arm_damping, device_damping;

  // The velocity at the middle of a step, which is also the step's mean. `error` is the motion from
  // the body to the plan at the beginning of the step, `plan` the plan's velocity.
  [[nodiscard]] Eigen::Vector3d midpoint(const Eigen::Vector3d& velocity,
                                         const Eigen::Vector3d& error, const Eigen::Vector3d& plan,
                                         const Eigen::Vector3d& force, double h) const noexcept {
    const double half = 0.5 * h / mass;
    const double resistance = arm_damping + device_damping + 0.5 * h * stiffness;
    return (velocity + half * (force + stiffness * error + arm_damping * plan)) /
           (1 + half * resistance);
  }
};

// The cosine of half a turn of motion_between.
double half_cosine(const Eigen::Vector3d& turn) noexcept {
  return 1 / std::sqrt(1 + 0.25 * turn.squaredNorm());
}

// Rounds down to whole steps.
Eigen::Vector3d quantised(const Eigen::Vector3d& exact, double step) noexcept {
  return {std::floor(exact.x() / step) * step, std::floor(exact.y() / step) * step,
          std::floor(exact.z() / step) * step};
}

}  // namespace

HandDevice::HandDevice(HandSettings settings)
    : settings_(checked(std::move(settings))),
      plan_(std::move(settings_.plan)),
      pose_(plan_.start()),
      planned_(plan_.start()) {}

std::optional<Placement> HandDevice::read() noexcept {
  const ScopedFloatEnvironment environment;
  Vector6 seen = motion_between(plan_.start(), pose_);
  if (settings_.resolution > 0) {
    seen.head<3>() = quantised(seen.head<3>(), settings_.resolution);
  }
  if (settings_.angular_resolution > 0) {
    seen.tail<3>() = quantised(seen.tail<3>(), settings_.angular_resolution);
  }
  Placement told = plan_.start().moved(seen);
  if (settings_.resolution == 0) told.translation = pose_.translation;
  if (settings_.angular_resolution == 0) told.rotation = pose_.rotation;
  return told;
}

void HandDevice::write(const Vector6& wrench, double dt) noexcept {
  const ScopedFloatEnvironment environment;
  constexpr double kRounding = 1 + 1e-9;
  if (!(dt * kRounding >= kShortestTick && dt <= kRounding * kLongestTick) || !wrench.allFinite())
    return;
  written_[(first_ + waiting_++) % kMostWritten] = {time_ + settings_.mechanics.delay, wrench};
  const double end = time_ + dt;
  const double longest = std::min(kLongestStep, dt / kFewestSteps);
  while (time_ < end) {
    for (; waiting_ > 0 && written_[first_].time <= time_; --waiting_) {
      felt_ = written_[first_].wrench;
      first_ = (first_ + 1) % kMostWritten;
    }
    // No step crosses a change of the wrench.
    const double until = waiting_ > 0 ? std::min(end, written_[first_].time) : end;
    const double begin = time_;
    const double steps = std::ceil((until - begin) / longest);
    const double h = (until - begin) / steps;
    double done = 0;
    while (done < steps) {
      time_ = begin + done * h;
      step(h);
      ++done;
    }
    time_ = until;
  }
  pose_ = pose_.moved(Vector6::Zero());
  planned_ = plan_.at(time_).pose;
}

void HandDevice::step(double h) noexcept {
  const PlanPoint plan = plan_.at(time_ + 0.5 * h);
  const Vector6 error = motion_between(pose_, plan.pose);
  const Oscillator body{settings_.mass, settings_.arm_stiffness, settings_.arm_damping,
                        settings_.mechanics.damping};
  // The spring's torque is 2k sin(turn/2), and `error` is twice a tangent. With this stiffness the
  // midpoint's torque times the turn is the energy released by the spring: with the turn's
  // quaternion q and the half angle's tangent s of the step,
  // U - U' = 2s · 2k (q_v - q_0 s/(1 + n))/n, n² = 1 + s².
  const Oscillator turning{settings_.inertia,
                           settings_.arm_angular_stiffness * half_cosine(error.tail<3>()),
                           settings_.arm_angular_damping, settings_.mechanics.angular_damping};
  Vector6 middle;
  middle << body.midpoint(velocity_.head<3>(), error.head<3>(), plan.velocity.head<3>(),
                          felt_.head<3>(), h),
      turning.midpoint(velocity_.tail<3>(), error.tail<3>(), plan.velocity.tail<3>(),
                       felt_.tail<3>(), h);
  const Vector6 motion = h * middle;
  pose_ = pose_.integrated_fast(motion);
  velocity_ = 2 * middle - velocity_;
  work_ += felt_.dot(motion);
  damped_ += h * (settings_.mechanics.damping * middle.head<3>().squaredNorm() +
                  settings_.mechanics.angular_damping * middle.tail<3>().squaredNorm());
}

double HandDevice::energy() const noexcept {
  const ScopedFloatEnvironment environment;
  const Vector6 error = motion_between(pose_, planned_);
  const double cosine = half_cosine(error.tail<3>());
  // 4k (1 - cosine) without cancellation.
  const double turned = 2 * error.tail<3>().squaredNorm() * cosine * cosine / (1 + cosine);
  return 0.5 * (settings_.mass * velocity_.head<3>().squaredNorm() +
                settings_.inertia * velocity_.tail<3>().squaredNorm() +
                settings_.arm_stiffness * error.head<3>().squaredNorm() +
                settings_.arm_angular_stiffness * turned);
}

}  // namespace ist
