#pragma once

#include <atomic>

namespace ist::cli {

/// Installs the handling of signals. SIGINT, SIGTERM and SIGHUP still end the process by the signal
/// itself, but unfinished files and the progress bar are removed first; a file that grows beyond
/// its limit (SIGXFSZ) is an error like a full disk. Must be called before there is any other
/// thread.
void install_signal_handlers();

/// Turns the first SIGINT, SIGTERM or SIGHUP during its lifetime into a request to stop: the
/// command stops and keeps its results. The next signal ends the process. One object at a time.
class StopOnInterruption {
 public:
  StopOnInterruption() noexcept;
  ~StopOnInterruption();
  StopOnInterruption(const StopOnInterruption&) = delete;
  StopOnInterruption& operator=(const StopOnInterruption&) = delete;

  /// Requests to stop, as a signal would.
  void ask() noexcept;
  /// Returns a flag that is set by the request.
  [[nodiscard]] const std::atomic<bool>& asked() const noexcept;
};

}  // namespace ist::cli
