#include "ist/haptics/servo_callback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"

namespace ist {
namespace {

using Clock = Budget::Clock;

Clock::duration seconds(double count) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(count));
}

void check(const ServoCallbackOptions& options) {
  if (!(std::isfinite(options.unit) && options.unit > 0)) {
    throw Error(
        ErrorCode::kInputInvalid,
        fmt::format("the poses' unit is {} m: name how many metres it has, such as 1 or 0.001",
                    options.unit));
  }
  if (!(options.query_share > 0 && options.query_share <= 1)) {
    throw Error(
        ErrorCode::kInputInvalid,
        fmt::format("queries may take {} of a tick: it has to be more than 0, and at most 1",
                    options.query_share));
  }
}

}  // namespace

ServoCallback::ServoCallback(Simulation& simulation, const ServoCallbackOptions& options)
    : simulation_(simulation), options_(options) {
  check(options);
  period_ = seconds(simulation.dt());
  query_time_ = seconds(options.query_share * simulation.dt());
}

ServoTick ServoCallback::on_tick(std::span<const double, 16> pose, std::span<double, 3> force,
                                 std::span<double, 3> torque) noexcept {
  const ScopedFloatEnvironment environment;
  const Clock::time_point begin = Clock::now();
  Eigen::Isometry3d device;
  device.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose.data());
  device.translation() *= options_.unit;

  Budget budget;
  if (options_.sphere_tests) {
    budget.sphere_tests = *options_.sphere_tests;
  } else {
    budget.deadline = begin + query_time_;
  }
  const Tick tick = simulation_.tick(Placement::from(device), {budget, budget});
  std::copy_n(tick.wrench.data(), 3, force.begin());
  std::copy_n(tick.wrench.data() + 3, 3, torque.begin());

  ++counts_.ticks;
  counts_.held += tick.held ? 1U : 0U;
  counts_.faults += tick.fault ? 1U : 0U;
  counts_.late += Clock::now() - begin > period_ ? 1U : 0U;
  if (tick.fault) return ServoTick::kFault;
  return tick.held ? ServoTick::kHeld : ServoTick::kFine;
}

void ServoCallback::fault() noexcept {
  simulation_.fault();
  ++counts_.ticks;
  ++counts_.faults;
}

ServoCallback::Pose ServoCallback::tool() const noexcept {
  const ScopedFloatEnvironment environment;
  Eigen::Isometry3d tool = simulation_.at().isometry();
  tool.translation() /= options_.unit;
  Pose pose;
  std::copy_n(tool.data(), pose.size(), pose.begin());
  return pose;
}

}  // namespace ist
