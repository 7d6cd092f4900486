#include "cli/interruption.h"

#include <csignal>
#include <thread>

#include "cli/progress_bar.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

// Returns the signals to handle. A signal that the caller chose to ignore stays ignored, as under
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

// `stops`: the next signal is a request to stop; `asked_to_stop`: there was one.
std::atomic<bool> stops{false}, asked_to_stop{false};

}  // namespace

void install_signal_handlers() {
  std::signal(SIGXFSZ, SIG_IGN);
  const sigset_t signals = ending_signals();
  // Every thread inherits the mask, so signals wait for the thread in sigwait(), which, unlike a
  // handler, may lock and free.
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
