#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "ist/base/progress.h"

namespace ist::cli {

/// Shows a Progress on stderr while this object lives: from two seconds on, and on a terminal only.
class ProgressBar {
 public:
  explicit ProgressBar(const Progress& progress);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

 private:
  void show();

  const Progress& progress_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

/// Clears the line of a bar that is shown, for a process that ends by a signal: a thread that draws
/// waits from then on for ever. Not for signal handlers: it takes a lock.
void abandon_progress_bar() noexcept;

}  // namespace ist::cli
