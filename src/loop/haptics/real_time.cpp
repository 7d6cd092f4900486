#include "loop/haptics/real_time.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "ist/base/assert.h"

namespace ist {
namespace {

constexpr std::size_t kStack = 256 * 1024;  // more than a tick needs

std::string cause(int error) { return std::system_category().message(error); }

// Tests whether the process may lock memory beyond its limit, without which mlockall would make
// later allocations fail. A trial is the only reliable test in a container with reduced privileges.
// The trial's memory is inaccessible, so no page is fetched. Returns 0 or an errno.
int try_to_lock_beyond(rlim_t limit) {
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t size = static_cast<std::size_t>(limit) / page * page + page;
  void* const memory = mmap(nullptr, size, PROT_NONE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_LOCKED, -1, 0);
  if (memory == MAP_FAILED) return errno;
  munmap(memory, size);
  return 0;
}

// Fetches the stack pages that a tick will use.
[[gnu::noinline]] void touch_stack() {
  std::array<volatile unsigned char, kStack> stack;
  for (std::size_t i = 0; i < kStack; i += 1024) stack[i] = 0;
}

}  // namespace

// Delegates first, so that the destructor restores the thread if a note throws.
RealTimeThread::RealTimeThread(const RealTimeOptions& options) : RealTimeThread() {
  if (options.lock_memory) ask_for_memory();
  touch_stack();
  if (options.cpu) ask_for_cpu(*options.cpu);
  ask_for_fifo(options.priority);
}

RealTimeThread::~RealTimeThread() {
  IST_ASSERT(owner_ == std::this_thread::get_id());
  if (policy_) {
    const sched_param parameters{.sched_priority = policy_->priority};
    sched_setscheduler(0, policy_->policy, &parameters);
  }
  if (affinity_) sched_setaffinity(0, sizeof *affinity_, &*affinity_);
  if (memory_locked_) munlockall();
}

void RealTimeThread::ask_for_fifo(int priority) {
  sched_param before{};
  const int policy = sched_getscheduler(0);
  const sched_param wanted{.sched_priority = priority};
  // SCHED_RESET_ON_FORK is kept if it is set: only root may clear it.
  if (policy >= 0 && sched_getparam(0, &before) == 0 &&
      sched_setscheduler(0, SCHED_FIFO | (policy & SCHED_RESET_ON_FORK), &wanted) == 0) {
    policy_ = Policy{policy, before.sched_priority};
    return;
  }
  const int error = errno;
  notes_.push_back(fmt::format(
      "SCHED_FIFO at priority {} was not permitted ({}): {}", priority, cause(error),
      error == EINVAL ? "name a priority from 1 to 99"
                      : "run as root, give the user rtprio in /etc/security/limits.conf, or give a "
                        "container CAP_SYS_NICE"));
}

void RealTimeThread::ask_for_memory() {
  rlimit limit{};
  int error = 0;
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    error = try_to_lock_beyond(limit.rlim_cur);
  if (error == 0) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
      memory_locked_ = true;
      return;
    }
    error = errno;
  }
  notes_.push_back(
      fmt::format("memory was not locked ({}): run as root, give the user memlock unlimited in "
                  "/etc/security/limits.conf, or give a container CAP_IPC_LOCK",
                  cause(error)));
}

void RealTimeThread::ask_for_cpu(int cpu) {
  cpu_set_t before, wanted;
  CPU_ZERO(&wanted);
  CPU_SET(static_cast<std::size_t>(cpu), &wanted);  // no effect beyond the set
  if (sched_getaffinity(0, sizeof before, &before) == 0 &&
      sched_setaffinity(0, sizeof wanted, &wanted) == 0) {
    affinity_ = before;
    return;
  }
  const int error = errno;
  notes_.push_back(fmt::format(
      "the loop was not pinned to processor {} ({}): name a processor that `taskset -pc $$` lists",
      cpu, cause(error)));
}

}  // namespace ist
