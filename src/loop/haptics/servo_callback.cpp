#include "ist/haptics/servo_callback.h"

#include <algorithm>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/base/platform/pause.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

using Clock = Budget::Clock;
using std::chrono::nanoseconds;

// The attempts of last(). Their pauses together take longer than a write.
constexpr int kAttempts = 64;

nanoseconds seconds(double count) {
  return std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>(count));
}

void check(const ServoCallbackOptions& options) {
  if (!(std::isfinite(options.unit) && options.unit > 0)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "the unit of poses is {} m: give its length in metres, such as 1 or 0.001",
                options.unit);
  }
  if (!(options.query_time_fraction > 0 && options.query_time_fraction <= 1)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "query_time_fraction is {}: give a number above 0 and at most 1",
                options.query_time_fraction);
  }
}

}  // namespace

ServoCallback::ServoCallback(Simulation& simulation, const ServoCallbackOptions& options)
    : simulation_(simulation), options_(options), device_(simulation.tool_pose()) {
  const ScopedFloatEnvironment environment;
  check(options);
  period_ = seconds(simulation.dt());
  query_time_ = seconds(options.query_time_fraction * simulation.dt());
}

Budget ServoCallback::budget_from(Clock::time_point begin) const noexcept {
  Budget budget;
  if (options_.sphere_tests) {
    budget.tests = *options_.sphere_tests;
  } else {
    budget.deadline = begin + query_time_;
  }
  return budget;
}

ChangeStatus ServoCallback::attach(std::size_t body) noexcept {
  const Budget budget = budget_from(Clock::now());
  return simulation_.attach(body, {budget, budget, budget});
}

ChangeStatus ServoCallback::release(std::size_t body) noexcept {
  const Budget budget = budget_from(Clock::now());
  return simulation_.release(body, {budget, budget, budget});
}

ServoTick ServoCallback::on_tick(std::span<const double, 16> pose, std::span<double, 3> force,
                                 std::span<double, 3> torque) noexcept {
  const ScopedFloatEnvironment environment;
  const Clock::time_point begin = Clock::now();
  Eigen::Isometry3d device;
  device.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose.data());
  device.translation() *= options_.unit;

  const Budget budget = budget_from(begin);
  const std::optional<Placement> known = Placement::from(device);
  const Tick tick = simulation_.tick(known, {budget, budget, budget});
  std::copy_n(tick.wrench.data(), 3, force.begin());
  std::copy_n(tick.wrench.data() + 3, 3, torque.begin());

  publish(tick, known.has_value(), begin);
  if (tick.fault) return ServoTick::kFault;
  return tick.held ? ServoTick::kHeld : ServoTick::kFine;
}

void ServoCallback::fault() noexcept {
  const Clock::time_point begin = Clock::now();
  simulation_.fault();
  Tick tick;
  tick.device = device_;
  tick.tool = simulation_.tool_pose();
  tick.fault = true;
  publish(tick, false, begin);
}

// Counts a tick, and shows it to other threads.
void ServoCallback::publish(const Tick& tick, bool device_known, Clock::time_point begin) noexcept {
  const nanoseconds taken = Clock::now() - begin;
  TickRecord record = record_of(counts_.ticks, simulation_.dt(), tick, device_known);
  record.begin_ns = nanoseconds(begin.time_since_epoch()).count();
  record.execution_ns = taken.count();
  device_ = tick.device;
  last_.publish(record);

  ++counts_.ticks;
  counts_.held += tick.held ? 1U : 0U;
  counts_.faults += tick.fault ? 1U : 0U;
  counts_.late += taken > period_ ? 1U : 0U;
}

std::optional<TickRecord> ServoCallback::last() const noexcept {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (const auto read = last_.try_read()) return *read;
    pause_briefly();
  }
  return std::nullopt;
}

ServoCallback::Pose ServoCallback::tool() const noexcept {
  const ScopedFloatEnvironment environment;
  Eigen::Isometry3d tool = simulation_.tool_pose().isometry();
  tool.translation() /= options_.unit;
  Pose pose;
  std::copy_n(tool.data(), pose.size(), pose.begin());
  return pose;
}

}  // namespace ist
