#include "ist/query/workers/resident_worker.h"

#include <time.h>
#include <unistd.h>

#include <thread>

#include "ist/base/float_environment.h"
#include "ist/base/platform/pause.h"
#include "ist/base/platform/timer_slack.h"
#include "ist/query/workers/worker_schedule.h"

namespace ist {
namespace {

using namespace worker_schedule;
using namespace std::chrono_literals;

// Everything here is static and has no destructor, so it still exists when TBB starts a task late,
// or when a static object with a handle is destroyed last.

// The state of the worker: kAsleep, kPolling, kAtWork, or the address of the offered job.
using Mail = std::uintptr_t;
constexpr Mail kAsleep = 0, kPolling = 1, kAtWork = 2;
alignas(64) std::atomic<Mail> mailbox{kAsleep};

Mail mail_of(Job& job) { return reinterpret_cast<Mail>(&job); }

// The last tick and period that callers report, in nanoseconds of the steady clock. All accesses
// are relaxed: a tick read with the period of another makes one nap too long or too short.
alignas(64) std::atomic<std::int64_t> last_tick{0}, last_period{0};

alignas(64) std::atomic<std::int64_t> wall_used{0}, cpu_used{0};

// At most one task of TBB's exists at any time, queued or running.
enum class Task : std::uint8_t { kNone, kQueued, kRunning };
std::atomic<Task> task{Task::kNone};
std::atomic<int> handles{0};

Clock::time_point time_of(std::int64_t ns) {
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(Nanoseconds(ns)));
}

std::int64_t count(Clock::time_point time) { return Nanoseconds(time.time_since_epoch()).count(); }

}  // namespace

// The worker's side.
class WorkerLoop {
 public:
  // Runs until there is no handle.
  void run() noexcept {
    while (handles.load(std::memory_order_seq_cst) > 0) {
      const Clock::time_point now = Clock::now();
      const std::int64_t tick = last_tick.load(std::memory_order_relaxed);
      if (tick != tick_) sign_ = now;
      tick_ = tick;
      const Nanoseconds period(last_period.load(std::memory_order_relaxed));
      const Clock::time_point look = always_awake.load(std::memory_order_relaxed)
                                         ? now
                                         : next_look(now, time_of(tick), sign_, period);
      if (look <= now) {
        poll();
        if (now - meter_.last_read() > 1ms) meter_.read(now);
      } else if (closes()) {
        meter_.read(now);
        std::this_thread::sleep_until(look);
      }
    }
    while (!closes()) {
    }
    meter_.read(Clock::now());
  }

 private:
  // Adds to the times of usage(), from its construction on.
  class Meter {
   public:
    void read(Clock::time_point now) noexcept {
      const std::int64_t cpu = thread_cpu();
      wall_used.fetch_add(Nanoseconds(now - wall_).count(), std::memory_order_relaxed);
      cpu_used.fetch_add(cpu - cpu_, std::memory_order_relaxed);
      wall_ = now;
      cpu_ = cpu;
    }
    [[nodiscard]] Clock::time_point last_read() const noexcept { return wall_; }

   private:
    static std::int64_t thread_cpu() noexcept {
      timespec time{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
      return time.tv_sec * 1'000'000'000 + time.tv_nsec;
    }
    Clock::time_point wall_ = Clock::now();
    std::int64_t cpu_ = thread_cpu();
  };

  // Polls for about a microsecond.
  void poll() noexcept {
    // Relaxed, here and below, where only the word itself is handed on: it lets an owner offer; the
    // worker's results reach the owner through the job.
    if (!awake_) mailbox.store(kPolling, std::memory_order_relaxed);
    awake_ = true;
    for (int i = 0; i < 16; ++i) {
      const Mail mail = mailbox.load(std::memory_order_relaxed);
      if (mail != kPolling) return serve(mail);
      pause_briefly();
    }
  }

  // Returns true when the mailbox is closed. A job found in it is done first, and then the mailbox
  // stays open.
  bool closes() noexcept {
    Mail mail = kPolling;
    if (!awake_ || mailbox.compare_exchange_strong(mail, kAsleep, std::memory_order_relaxed)) {
      awake_ = false;
      return true;
    }
    serve(mail);
    return false;
  }

  void serve(Mail mail) noexcept {
    hand_over(HandOver::kSeen);
    // Acquire: pairs with offer(). The job is not read before: its owner may have retracted and
    // destroyed it. If the same job was offered again meanwhile, the later offer is entered.
    if (!mailbox.compare_exchange_strong(mail, kAtWork, std::memory_order_acquire,
                                         std::memory_order_relaxed))
      return;
    hand_over(HandOver::kEntered);
    Job& job = *reinterpret_cast<Job*>(mail);  // NOLINT(performance-no-int-to-ptr)
    {
      const ScopedFloatEnvironment environment;
      job.run_(job.context_);
    }
    // Release: pairs with Job::busy(). The owner may destroy the job at once.
    job.busy_.store(false, std::memory_order_release);
    mailbox.store(kPolling, std::memory_order_relaxed);
    sign_ = Clock::now();
  }

  bool awake_ = false;
  std::int64_t tick_ = last_tick.load(std::memory_order_relaxed);
  Clock::time_point sign_ = Clock::now();  // making a handle is a sign of life
  Meter meter_;
};

namespace {

void stay(void*) {
  task.store(Task::kRunning);
  Task none = Task::kNone;
  do {
    const ScopedTimerSlack slack;
    WorkerLoop().run();
    task.store(Task::kNone);
    // A handle made just now starts no task if it finds this one. It counts itself and then looks
    // for a task; here the order is the reverse. All four accesses are sequentially consistent, so
    // one of the two sees the other.
    none = Task::kNone;
  } while (handles.load() > 0 && task.compare_exchange_strong(none, Task::kRunning));
}

}  // namespace

ResidentWorker::ResidentWorker() {
  handles.fetch_add(1);
  Task none = Task::kNone;
  if (task.compare_exchange_strong(none, Task::kQueued)) run_aside(stay, nullptr);
}

ResidentWorker::~ResidentWorker() {
  if (handles.fetch_sub(1) > 1) return;
  // A queued task is not waited for: it may never start, and returns at once if it does. A running
  // task is waited for with a limit: after fork() the child has the parent's state without its
  // threads.
  const Clock::time_point give_up = Clock::now() + 20 * kLongNap;
  while (handles.load() == 0 && task.load() == Task::kRunning && Clock::now() < give_up)
    std::this_thread::sleep_for(100us);
}

void ResidentWorker::tick(Clock::time_point now, Nanoseconds period) noexcept {
  last_period.store(period.count(), std::memory_order_relaxed);
  last_tick.store(count(now), std::memory_order_relaxed);
}

bool ResidentWorker::offer(Job& job) noexcept {
  if (mailbox.load(std::memory_order_relaxed) != kPolling || job.busy()) return false;
  job.busy_.store(true, std::memory_order_relaxed);
  Mail polling = kPolling;
  // Release: the worker that enters the job sees it and all that its owner wrote before.
  if (mailbox.compare_exchange_strong(polling, mail_of(job), std::memory_order_release,
                                      std::memory_order_relaxed))
    return true;
  job.busy_.store(false, std::memory_order_relaxed);
  return false;
}

bool ResidentWorker::retract(Job& job) noexcept {
  Mail mail = mail_of(job);
  // Relaxed: the worker wrote nothing, and the next offer publishes its own data.
  if (!mailbox.compare_exchange_strong(mail, kPolling, std::memory_order_relaxed)) return false;
  job.busy_.store(false, std::memory_order_relaxed);
  return true;
}

ResidentWorker::Usage ResidentWorker::usage() noexcept {
  return {Nanoseconds(wall_used.load(std::memory_order_relaxed)),
          Nanoseconds(cpu_used.load(std::memory_order_relaxed))};
}

bool ResidentWorker::is_there() noexcept { return task.load() == Task::kRunning; }

Job::Job(Run run, void* context) noexcept : run_(run), context_(context), process_(getpid()) {}

void Job::wait_idle() const noexcept {
  while (busy() && process_ == getpid()) {
    idle_naps.fetch_add(1, std::memory_order_relaxed);
    std::this_thread::sleep_for(50us);
  }
}

}  // namespace ist
