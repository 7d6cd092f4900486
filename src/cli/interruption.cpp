#include "cli/interruption.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>

#include "cli/progress_bar.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kSameSignal{1};
// What is left of 1 s is for removing files and the bar, and for the system.
constexpr std::chrono::milliseconds kLastWait{800};

// What the thread that waits for signals shares with the others.
struct Shared {
  std::atomic<bool> stops{false};  // a StopOnInterruption lives
  std::atomic<bool> asked{false}, hurried{false};
  bool ends_by_pipe = false;
  std::mutex mutex;  // of `holds`
  std::condition_variable released;
  int holds = 0;

  // Never destroyed: a signal may also come while the process ends.
  static Shared& one() {
    static auto& shared = *new Shared;
    return shared;
  }
};

bool has_default(int signal) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_DFL;
}

// Returns the signals to handle. A signal that the caller chose to ignore stays ignored, as under
// nohup.
sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    if (has_default(signal)) sigaddset(&signals, signal);
  }
  return signals;
}

void await_holds() {
  Shared& shared = Shared::one();
  std::unique_lock lock(shared.mutex);
  shared.released.wait_for(lock, kLastWait, [&] { return shared.holds == 0; });
}

// Waits for the signal that ends the process, and returns it. Meanwhile the first signal asks a run
// to stop, and a later one waits for the run's files.
int await_end_by_signal(const sigset_t& signals) {
  Shared& shared = Shared::one();
  std::optional<Clock::time_point> first;
  while (true) {
    int signal = 0;
    sigwait(&signals, &signal);
    if (signal == SIGQUIT) return signal;
    const Clock::time_point now = Clock::now();
    if (!first) {
      if (!shared.stops) return signal;
      first = now;
      shared.asked = true;
    } else if (now - *first >= kSameSignal) {
      shared.hurried = true;
      await_holds();
      return signal;
    }
  }
}

[[noreturn]] void end_by_signals(const sigset_t& signals) {
  const int signal = await_end_by_signal(signals);
  Shared::one().hurried ? complete_output_files() : abandon_output_files();
  abandon_progress_bar();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  raise(signal);
  std::_Exit(128 + signal);  // the first process of a container does not die by signals
}

}  // namespace

void install_signal_handlers() {
  std::signal(SIGXFSZ, SIG_IGN);
  Shared::one().ends_by_pipe = has_default(SIGPIPE);
  std::signal(SIGPIPE, SIG_IGN);
  const sigset_t signals = ending_signals();
  // Every thread inherits the mask, so signals wait for the thread in sigwait(), which, unlike a
  // handler, may lock and free.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] { end_by_signals(signals); }).detach();
}

void end_by_broken_pipe() noexcept {
  if (!Shared::one().ends_by_pipe) return;
  std::signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}

StopOnInterruption::StopOnInterruption() noexcept { Shared::one().stops = true; }

StopOnInterruption::~StopOnInterruption() { Shared::one().stops = false; }

void StopOnInterruption::ask() noexcept { Shared::one().asked = true; }

const std::atomic<bool>& StopOnInterruption::asked() const noexcept { return Shared::one().asked; }

bool StopOnInterruption::hurried() const noexcept { return Shared::one().hurried; }

void StopOnInterruption::await_end() const noexcept {
  while (true) ::pause();
}

HoldEnd::HoldEnd() {
  Shared& shared = Shared::one();
  const std::lock_guard lock(shared.mutex);
  ++shared.holds;
}

HoldEnd::~HoldEnd() {
  Shared& shared = Shared::one();
  const std::lock_guard lock(shared.mutex);
  --shared.holds;
  shared.released.notify_all();
}

}  // namespace ist::cli
