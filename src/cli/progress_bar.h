#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "ist/base/progress.h"

namespace ist::cli {

/// A Progress that is drawn on stderr during its lifetime: from two seconds on, and on a terminal
/// only.
class ProgressBar : public Progress {
 public:
  /// Draws each stage from 0 to 100 %.
  ProgressBar() : ProgressBar(0) {}
  /// Draws work of many stages as one bar. The bar grows by one of `parts` at each end_part(), and
  /// the name of the stage stands beside it.
  explicit ProgressBar(unsigned parts);
  void end_part() noexcept { parts_done_.fetch_add(1, std::memory_order_relaxed); }

  /// Returns the drawn part of the bar, 0 to 1.
  [[nodiscard]] double drawn_fraction() const noexcept;

 private:
  unsigned parts_;
  std::atomic<unsigned> parts_done_{0};
  std::jthread thread_;
};

/// Prints lines to stderr in place of a visible bar, and the bar is drawn again below them.
void print_past_progress_bar(const std::string& lines);

/// Clears the line of a visible bar before the process ends by a signal, unless the terminal takes
/// no output now; waits at most 0.1 s. A thread that draws then waits for ever. Takes a lock, so no
/// signal handler may call it.
void abandon_progress_bar() noexcept;

}  // namespace ist::cli
