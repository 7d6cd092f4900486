#pragma once

#include <atomic>

namespace ist::cli {

/// Installs the handling of signals. SIGINT, SIGTERM, SIGHUP and SIGQUIT still end the process by
/// the signal itself, but unfinished files and the progress bar are removed first; a file that
/// grows beyond its limit (SIGXFSZ) is an error like a full disk, and so is a pipe without a reader
/// (SIGPIPE). Must be called before there is any other thread.
void install_signal_handlers();

/// Ends the process by SIGPIPE, as one that writes to `head` ends, unless the caller chose to
/// ignore that signal: then returns. Call it after the stack is unwound.
void end_by_broken_pipe() noexcept;

/// Turns the first SIGINT, SIGTERM or SIGHUP during its lifetime into a request to stop: the
/// command stops and keeps its results. Another one within 1 s of the first is the same one, even
/// after the lifetime: `timeout` signals a process, and then its group. A later one ends the
/// process within 1 s: it waits for each HoldEnd, and for nothing else. SIGQUIT always ends the
/// process at once. One object a process.
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
  /// Returns whether a later signal came, so that the process is about to end.
  [[nodiscard]] bool hurried() const noexcept;
  /// Waits for that end.
  [[noreturn]] void await_end() const noexcept;
};

/// Holds the end of the process after a later signal, for 0.8 s at most, until it is destroyed: by
/// then a file should be whole. A file that only waits for the disk in OutputFile::commit() after
/// that time is kept, and any other unfinished file is removed. In any thread.
class HoldEnd {
 public:
  HoldEnd();
  ~HoldEnd();
  HoldEnd(const HoldEnd&) = delete;
  HoldEnd& operator=(const HoldEnd&) = delete;
};

}  // namespace ist::cli
