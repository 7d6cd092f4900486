#pragma once

#include <atomic>

namespace ist::cli {

/// From now on SIGINT, SIGTERM and SIGHUP still end the process, by the signal itself, but no
/// unfinished file stays behind and no progress bar; and a file that grows beyond its limit
/// (SIGXFSZ) is an error like a full disk. To be called before there is any other thread.
void leave_nothing_half_done();

/// While it lives, the first of those signals does not end the process but asks it to stop: what
/// runs comes to rest and keeps what it has. The next one ends it. One at a time.
class StopOnInterruption {
 public:
  StopOnInterruption() noexcept;
  ~StopOnInterruption();
  StopOnInterruption(const StopOnInterruption&) = delete;
  StopOnInterruption& operator=(const StopOnInterruption&) = delete;

  /// As a signal would.
  void ask() noexcept;
  [[nodiscard]] const std::atomic<bool>& asked() const noexcept;
};

}  // namespace ist::cli
