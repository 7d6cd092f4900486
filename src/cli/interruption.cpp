#include "cli/interruption.h"

#include <csignal>
#include <thread>

#include "cli/progress_bar.h"
#include "ist/base/output_file.h"

namespace ist::cli {
namespace {

// Those that would end the process; one that the caller chose to ignore stays ignored, as under
// nohup.
sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_DFL) sigaddset(&signals, signal);
  }
  return signals;
}

// Whether the next signal asks to stop, and whether one has.
std::atomic<bool> stops{false}, asked_to_stop{false};

}  // namespace

void leave_nothing_half_done() {
  std::signal(SIGXFSZ, SIG_IGN);
  const sigset_t signals = ending_signals();
  // Threads take after the one that makes them, so the signal waits for the one that waits for it:
  // which may lock and free, as no handler may.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int signal = 0;
    do {
      if (sigwait(&signals, &signal) != 0) return;
    } while (stops.exchange(false) && !asked_to_stop.exchange(true));
    abandon_progress_bar();
    abandon_output_files();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    raise(signal);
  }).detach();
}

StopOnInterruption::StopOnInterruption() noexcept {
  asked_to_stop = false;
  stops = true;
}

StopOnInterruption::~StopOnInterruption() { stops = false; }

void StopOnInterruption::ask() noexcept { asked_to_stop = true; }

const std::atomic<bool>& StopOnInterruption::asked() const noexcept { return asked_to_stop; }

}  // namespace ist::cli
