#pragma once

#include <thread>

#include "ist/base/progress.h"

namespace ist::cli {

/// A Progress that is drawn on stderr during its lifetime: from two seconds on, and on a terminal
/// only.
class ProgressBar : public Progress {
 public:
  ProgressBar();

 private:
  std::jthread thread_;
};

/// Clears the line of a visible bar before the process ends by a signal, unless the terminal takes
/// no output now; waits at most 0.1 s. A thread that draws then waits for ever. Takes a lock, so no
/// signal handler may call it.
void abandon_progress_bar() noexcept;

}  // namespace ist::cli
