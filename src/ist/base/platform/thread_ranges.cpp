// What tbb_ranges.cpp does, by threads that live as long as a loop: for builds that link nothing
// but libc. A loop that takes a millisecond does not notice how long a thread takes to start.

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "ist/base/parallel.h"

namespace ist {
namespace {

// The limits that live. Never destroyed, for a static object may hold one until the process ends.
struct ThreadLimits {
  std::mutex mutex;
  std::multiset<std::size_t> living;
};

ThreadLimits& thread_limits() {
  static ThreadLimits& limits = *new ThreadLimits;
  return limits;
}

std::size_t smallest_limit() {
  ThreadLimits& limits = thread_limits();
  const std::lock_guard lock(limits.mutex);
  return limits.living.empty() ? std::numeric_limits<std::size_t>::max() : *limits.living.begin();
}

// Whether this thread works on a loop. A loop within it has no cores left, and runs in this thread.
thread_local bool in_a_loop = false;

// A loop whose ranges go to whichever thread asks next, in ascending order.
class SharedLoop {
 public:
  SharedLoop(std::size_t ranges, void (*run)(void*, std::size_t), void* context)
      : ranges_(ranges), run_(run), context_(context) {}

  // Runs ranges until none is left.
  void work() noexcept {
    in_a_loop = true;
    for (;;) {
      const std::size_t range = next_.fetch_add(1, std::memory_order_relaxed);
      if (range >= ranges_) break;
      try {
        run_(context_, range);
      } catch (...) {
        keep(range, std::current_exception());
      }
    }
    in_a_loop = false;
  }

  // After all threads have ended: throws what the first range threw that failed. All ranges before
  // it have been run, so it is the same one for any number of threads.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void keep(std::size_t range, std::exception_ptr failure) noexcept {
    next_.store(ranges_, std::memory_order_relaxed);  // the others are not begun
    const std::lock_guard lock(mutex_);
    if (failure_ && range > failed_) return;
    failed_ = range;
    failure_ = std::move(failure);
  }

  const std::size_t ranges_;
  void (*const run_)(void*, std::size_t);
  void* const context_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::size_t failed_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

void run_ranges(std::size_t ranges, void (*run)(void*, std::size_t), void* context) {
  const std::size_t threads =
      in_a_loop || ranges < 2 ? 1 : std::min({ranges, thread_count(), smallest_limit()});
  if (threads < 2) {
    for (std::size_t range = 0; range < ranges; ++range) run(context, range);
    return;
  }
  SharedLoop loop(ranges, run, context);
  {
    std::vector<std::jthread> others;  // joined at the end of this block
    others.reserve(threads - 1);
    try {
      while (others.size() < threads - 1) others.emplace_back([&loop] { loop.work(); });
    } catch (const std::exception&) {
      // The system has no thread left: those that have started and this one do the work.
    }
    loop.work();
  }
  loop.rethrow();
}

void run_aside(void (*run)(void*), void* context) {
  try {
    std::thread([=] { run(context); }).detach();
  } catch (const std::exception&) {
    // As if no thread became free: callers do without.
  }
}

std::size_t thread_count() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof(allowed), &allowed) == 0)
    return static_cast<std::size_t>(std::max(1, CPU_COUNT(&allowed)));
  return std::max(1u, std::thread::hardware_concurrency());  // more processors than a set holds
}

struct ScopedThreadLimit::Control {
  explicit Control(std::size_t threads) {
    ThreadLimits& limits = thread_limits();
    const std::lock_guard lock(limits.mutex);
    place = limits.living.insert(threads);
  }
  ~Control() {
    ThreadLimits& limits = thread_limits();
    const std::lock_guard lock(limits.mutex);
    limits.living.erase(place);
  }
  std::multiset<std::size_t>::iterator place;
};

ScopedThreadLimit::ScopedThreadLimit(std::size_t threads) : control_(new Control(threads)) {}
ScopedThreadLimit::~ScopedThreadLimit() = default;

}  // namespace ist
