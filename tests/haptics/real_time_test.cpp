#include "loop/haptics/real_time.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iostream>
#include <string_view>

#include "support/effort.h"

namespace ist::test {
namespace {

// What is changed is a thread's, so each test has one of its own.
void in_a_thread(const std::function<void()>& work) { std::thread(work).join(); }

long notes_with(const RealTimeThread& thread, std::string_view text) {
  return std::count_if(thread.notes().begin(), thread.notes().end(), [&](const std::string& note) {
    return note.find(text) != std::string::npos;
  });
}
long fifo_notes(const RealTimeThread& thread) { return notes_with(thread, "SCHED_FIFO"); }
long memory_notes(const RealTimeThread& thread) { return notes_with(thread, "memory was"); }
long cpu_notes(const RealTimeThread& thread) { return notes_with(thread, "processor"); }

cpu_set_t processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return set;
}

int first_processor() {
  const cpu_set_t set = processors();
  int cpu = 0;
  while (!CPU_ISSET(static_cast<std::size_t>(cpu), &set)) ++cpu;
  return cpu;
}

int priority() {
  sched_param parameters{};
  EXPECT_EQ(sched_getparam(0, &parameters), 0);
  return parameters.sched_priority;
}

// What the system says of this process, KiB.
long memory(std::string_view name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return std::stol(line.substr(name.size()));
  }
  return 0;
}
long locked_memory() { return memory("VmLck:"); }

// Sanitizers make nothing of a request to lock memory, and say that it was done.
bool locks_in_earnest() {
  alignas(4096) static unsigned char page[4096];
  if (mlock(page, sizeof page) != 0) return false;
  const long locked = locked_memory();
  munlock(page, sizeof page);
  return locked > 0;
}

TEST(RealTimeThread, WhatIsAskedForIsEitherGrantedOrNoted) {
  in_a_thread([] {
    const int cpu = first_processor();
    const bool in_earnest = locks_in_earnest();
    const RealTimeThread thread({.priority = 7, .cpu = cpu, .lock_memory = true});
    for (const std::string& note : thread.notes()) std::cout << note << '\n';

    EXPECT_LE(prctl(PR_GET_TIMERSLACK), 1);
    EXPECT_EQ(fifo_notes(thread), thread.fifo() ? 0 : 1);
    EXPECT_EQ(sched_getscheduler(0) == SCHED_FIFO, thread.fifo());
    if (thread.fifo()) {
      EXPECT_EQ(priority(), 7);
    }

    EXPECT_EQ(memory_notes(thread), thread.memory_locked() ? 0 : 1);
    if (in_earnest) {
      EXPECT_EQ(locked_memory() > 0, thread.memory_locked());
    }

    EXPECT_EQ(cpu_notes(thread), thread.pinned() ? 0 : 1);
    if (thread.pinned()) {
      const cpu_set_t set = processors();
      EXPECT_EQ(CPU_COUNT(&set), 1);
      EXPECT_TRUE(CPU_ISSET(static_cast<std::size_t>(cpu), &set));
    }
    EXPECT_EQ(
        thread.notes().size(),
        static_cast<std::size_t>(3 - thread.fifo() - thread.memory_locked() - thread.pinned()));
  });
}

TEST(RealTimeThread, WhatIsNotAskedForIsNeitherGrantedNorNoted) {
  in_a_thread([] {
    const cpu_set_t before = processors();
    const long locked = locked_memory();
    const RealTimeThread thread({.lock_memory = false});
    EXPECT_FALSE(thread.memory_locked());
    EXPECT_EQ(memory_notes(thread), 0);
    EXPECT_EQ(locked_memory(), locked);
    EXPECT_FALSE(thread.pinned());
    EXPECT_EQ(cpu_notes(thread), 0);
    const cpu_set_t after = processors();
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
  });
}

TEST(RealTimeThread, PutsBackWhatTheThreadHadBefore) {
  in_a_thread([] {
    const cpu_set_t before = processors();
    const int policy = sched_getscheduler(0), slack = prctl(PR_GET_TIMERSLACK);
    munlockall();
    const long locked = locked_memory();
    { const RealTimeThread thread({.cpu = first_processor()}); }
    const cpu_set_t after = processors();
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
    EXPECT_EQ(sched_getscheduler(0), policy);
    EXPECT_EQ(priority(), 0);
    EXPECT_EQ(prctl(PR_GET_TIMERSLACK), slack);
    EXPECT_EQ(locked_memory(), locked);
  });
}

TEST(RealTimeThread, PutsBackARealTimePriorityToo) {
  in_a_thread([] {
    const sched_param earlier{.sched_priority = 3};
    if (sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &earlier) != 0)
      IST_SKIP("real-time scheduling is not permitted here");
    {
      const RealTimeThread thread({.priority = 5, .lock_memory = false});
      EXPECT_TRUE(thread.fifo());
      EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO | SCHED_RESET_ON_FORK);
      EXPECT_EQ(priority(), 5);
    }
    EXPECT_EQ(sched_getscheduler(0), SCHED_RR | SCHED_RESET_ON_FORK);
    EXPECT_EQ(priority(), 3);
  });
}

TEST(RealTimeThread, NotesAProcessorThatDoesNotExist) {
  for (const int cpu : {-1, CPU_SETSIZE, 1000000}) {
    in_a_thread([cpu] {
      const cpu_set_t before = processors();
      const RealTimeThread thread({.cpu = cpu, .lock_memory = false});
      EXPECT_FALSE(thread.pinned());
      ASSERT_EQ(cpu_notes(thread), 1);
      EXPECT_EQ(notes_with(thread, "processor " + std::to_string(cpu)), 1);
      EXPECT_EQ(notes_with(thread, "Invalid argument"), 1);
      const cpu_set_t after = processors();
      EXPECT_TRUE(CPU_EQUAL(&before, &after));
    });
  }
}

TEST(RealTimeThread, NotesAPriorityThatDoesNotExist) {
  for (const int wrong : {-1, 0, 100}) {
    in_a_thread([wrong] {
      const RealTimeThread thread({.priority = wrong, .lock_memory = false});
      EXPECT_FALSE(thread.fifo());
      EXPECT_EQ(notes_with(thread, "from 1 to 99"), 1) << wrong;
      EXPECT_NE(sched_getscheduler(0), SCHED_FIFO);
    });
  }
}

// In a child process, which then has no privileges and may lock what it has, but not much more (or
// less, where its limit cannot be raised): ends it by 0 where all is as it should be, by the number
// of what is not, and by 100 where privileges cannot be dropped.
[[noreturn]] void ask_without_privileges() {
  constexpr std::size_t kMore = 1 << 20;
  rlimit memory_limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &memory_limit) != 0) _exit(100);
  const rlim_t little = static_cast<rlim_t>(memory("VmSize:")) * 1024 + kMore;
  memory_limit.rlim_cur = memory_limit.rlim_max = std::min(memory_limit.rlim_max, little);
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_MEMLOCK, &memory_limit) != 0 || setrlimit(RLIMIT_RTPRIO, &none) != 0)
    _exit(100);
  if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(100);
  const RealTimeThread thread({.priority = 1});
  if (thread.fifo() || fifo_notes(thread) != 1) _exit(1);
  if (notes_with(thread, "(Operation not permitted): run as root") != 1) _exit(2);
  if (thread.memory_locked() || memory_notes(thread) != 1) _exit(3);
  if (notes_with(thread, "memlock") != 1) _exit(4);
  // Nothing that is allocated from now on is refused for being too much to lock.
  void* const more = mmap(nullptr, 1 << 24, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (more == MAP_FAILED) _exit(5);
  _exit(0);
}

TEST(RealTimeThread, AsksForNoMemoryThatItsLimitWouldThenRefuse) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) ask_without_privileges();
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 100) IST_SKIP("privileges cannot be dropped here");
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace ist::test
