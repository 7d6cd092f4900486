#include "c/follower.h"

#include <algorithm>
#include <future>

#include "c/sized_struct.h"
#include "ist/base/cancellation.h"

namespace ist::capi {
namespace {

// `part` says how much is done, `stop` ends the work.
bool run_beside(const ist_progress& follower, const std::function<void()>& work,
                const std::function<double()>& part, const std::function<void()>& stop) {
  if (follower.report(follower.user, 0) != 0) return false;
  std::future<void> ended = std::async(std::launch::async, work);
  bool stopped = false;
  double told = 0;
  while (ended.wait_for(time_between_reports().load()) != std::future_status::ready) {
    told = std::max(told, part());
    if (stopped || follower.report(follower.user, told) == 0) continue;
    stopped = true;
    stop();
  }
  if (!stopped) ended.get();
  return !stopped;
}

}  // namespace

std::atomic<std::chrono::microseconds>& time_between_reports() noexcept {
  static std::atomic<std::chrono::microseconds> between{std::chrono::milliseconds(20)};
  return between;
}

Follower read_follower(Call& call, const ist_progress* given) {
  const ist_progress known = read_sized(call, "progress", given);
  return known.report != nullptr ? Follower(known) : std::nullopt;
}

bool followed(const Follower& follower, const std::function<void(const Proceed&)>& work) {
  if (!follower) {
    work({});
    return true;
  }
  std::atomic<double> done{0};
  std::atomic<bool> stopped{false};
  const Proceed proceed = [&](double part) {
    done.store(part, std::memory_order_relaxed);
    return !stopped.load(std::memory_order_relaxed);
  };
  const auto cancellable = [&] {
    const ScopedCancellation cancellation(stopped);
    work(proceed);
  };
  return run_beside(
      *follower, cancellable, [&] { return done.load(std::memory_order_relaxed); },
      [&] { stopped.store(true, std::memory_order_relaxed); });
}

bool followed(const Follower& follower, Progress& progress, unsigned stages,
              const std::function<void()>& work) {
  if (!follower) {
    work();
    return true;
  }
  const auto part = [&] {
    const double begun = std::max(1U, progress.stages());
    return std::min(1.0, (begun - 1 + progress.fraction()) / stages);
  };
  return run_beside(*follower, work, part, [&] { progress.stop(); });
}

void cancelled(Call& call) {
  call.fail(IST_CANCELLED,
            "progress->report returned another number than 0: the call was ended as it asked");
}

}  // namespace ist::capi
