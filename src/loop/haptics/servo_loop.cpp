#include "ist/haptics/servo_loop.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "ist/base/throw_error.h"
#include "loop/haptics/real_time.h"
#include "loop/haptics/tick_clock.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

nanoseconds effects_time(const Simulation& simulation) noexcept {
  nanoseconds sum{};
  for (const EffectTime& effect : simulation.effects()) sum += effect.time;
  return sum;
}

nanoseconds thread_time() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + nanoseconds(time.tv_nsec);
}

class Loop {
 public:
  Loop(Simulation& simulation, Device& device, const ServoOptions& options,
       const ServoOutputs& outputs)
      : simulation_(simulation),
        device_(device),
        options_(options),
        outputs_(outputs),
        period_(static_cast<nanoseconds::rep>(1e9 * simulation.dt())),
        clock_(period_) {}

  ServoReport run(const std::atomic<bool>& stop) {
    if (outputs_.progress != nullptr) {
      outputs_.progress->begin_stage("running the servo loop", options_.ticks);
    }
    clock_.start();
    Clock::time_point begin = Clock::now();
    TickStart start{};
    for (std::uint64_t tick = 0;
         tick < options_.ticks && !stop.load(std::memory_order_relaxed) && !device_.done();) {
      keep(make_tick(tick, begin, start));
      if (options_.paced) {
        start = clock_.wait_for_next();
        report_.missed += start.missed;
        tick = clock_.tick();
      } else {
        ++tick;
      }
      begin = Clock::now();
    }
    device_.write(Vector6::Zero(), simulation_.dt());
    return std::move(report_);
  }

 private:
  [[nodiscard]] TickBudget budget() noexcept {
    TickBudget budget;
    if (options_.paced) {
      budget.contacts.deadline = budget.proximity.deadline = budget.change.deadline =
          clock_.release() +
          nanoseconds(static_cast<nanoseconds::rep>(options_.query_time_fraction *
                                                    static_cast<double>(period_.count())));
    }
    return budget;
  }

  [[nodiscard]] TickRecord make_tick(std::uint64_t number, Clock::time_point begin,
                                     const TickStart& start) noexcept {
    const nanoseconds used = thread_time(), effects = effects_time(simulation_);
    const std::optional<Placement> at = device_.read();
    const Tick tick = simulation_.tick(at, budget());
    device_.write(tick.wrench, simulation_.dt());
    const Clock::time_point end = Clock::now();
    const nanoseconds processor = thread_time() - used;

    TickRecord record = record_of(number, simulation_.dt(), tick, at.has_value());
    record.begin_ns = nanoseconds(begin.time_since_epoch()).count();
    record.late_ns = start.late.count();
    record.execution_ns = nanoseconds(end - begin).count();
    record.cpu_ns = processor.count();
    if (record.cpu_ns > report_.worst_cpu.count()) {
      report_.worst_cpu = processor;
      report_.worst_effects = effects_time(simulation_) - effects;
    }
    if (options_.paced && end > clock_.deadline()) ++report_.missed;
    return record;
  }

  void keep(const TickRecord& record) noexcept {
    ++report_.ticks;
    report_.held += record.held ? 1U : 0U;
    report_.faults += record.fault ? 1U : 0U;
    report_.halved += record.halved ? 1U : 0U;
    report_.steps += static_cast<std::uint64_t>(record.steps);
    count(std::span(record.points).first(record.point_count));
    if (record.contacts && record.contacts->complete) count(record.contacts->found);
    report_.late.record(nanoseconds(record.late_ns));
    report_.execution.record(nanoseconds(record.execution_ns));
    report_.cpu.record(nanoseconds(record.cpu_ns));
    if (outputs_.records != nullptr) push(record);
    if (outputs_.snapshot != nullptr) outputs_.snapshot->publish(record);
    if (outputs_.receiver != nullptr) outputs_.receiver->take(record);
    if (outputs_.progress != nullptr) outputs_.progress->add(1);
  }

  void count(std::span<const ContactRecord> points) noexcept {
    if (points.empty()) return;
    ++report_.in_contact;
    report_.most_points = std::max(report_.most_points, static_cast<std::uint32_t>(points.size()));
    for (const ContactRecord& point : points) {
      const auto [x, y, z] = point.force;
      report_.largest_point_force =
          std::max(report_.largest_point_force, std::sqrt(x * x + y * y + z * z));
    }
  }

  void count(Found found) noexcept {
    switch (found) {
      case Found::kFresh:
        ++report_.fresh;
        break;
      case Found::kKept:
        ++report_.kept;
        break;
      case Found::kClear:
        ++report_.clear;
        break;
    }
  }

  void push(const TickRecord& record) noexcept {
    while (!outputs_.records->push(record)) {
      if (options_.paced || outputs_.records->closed()) {
        ++report_.lost_records;
        return;
      }
      std::this_thread::yield();  // an unpaced loop has time
    }
  }

  Simulation& simulation_;
  Device& device_;
  const ServoOptions& options_;
  const ServoOutputs& outputs_;
  nanoseconds period_;
  TickClock clock_;
  ServoReport report_;
};

}  // namespace

ServoReport run_servo_loop(Simulation& simulation, Device& device, const ServoOptions& options,
                           const ServoOutputs& outputs, const std::atomic<bool>& stop) {
  if (!(options.query_time_fraction > 0 && options.query_time_fraction <= 1)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "query_time_fraction is {}: give a number above 0 and at most 1",
                options.query_time_fraction);
  }
  // An unpaced loop must not keep other threads from their processor.
  std::optional<RealTimeThread> real_time;
  if (options.paced) real_time.emplace(options.real_time);
  ServoReport report = Loop(simulation, device, options, outputs).run(stop);
  if (real_time) report.notes = real_time->notes();
  return report;
}

}  // namespace ist
