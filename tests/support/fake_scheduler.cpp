#include "support/fake_scheduler.h"

#include <algorithm>
#include <cmath>

namespace ist::test {

void FakeScheduler::drop(std::uint64_t first, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) dropped_.push_back(first + i);
}

void FakeScheduler::delay(std::uint64_t tick, double seconds) {
  delays_.emplace_back(tick, seconds);
}

std::vector<FakeScheduler::Call> FakeScheduler::run(std::uint64_t ticks) {
  std::vector<Call> calls;
  calls.reserve(ticks);
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    if (std::find(dropped_.begin(), dropped_.end(), tick) != dropped_.end()) continue;
    Call call{1e-3 * static_cast<double>(tick), 0, {}, {}};
    for (const auto& [late, seconds] : delays_) {
      if (late == tick) call.time += seconds;
    }
    double pose[16];
    path_(call.time, pose);
    // What a callback does not write shows.
    std::fill_n(call.force, 3, std::nan(""));
    std::fill_n(call.torque, 3, std::nan(""));
    call.answer = callback_(user_, pose, call.force, call.torque);
    calls.push_back(call);
  }
  return calls;
}

}  // namespace ist::test
