#pragma once

#include <array>
#include <optional>
#include <string>

#include "cli/bench/samples.h"

namespace ist::cli {

/// The machine that a bench runs on, before anything is measured.
struct Machine {
  std::string processor;  ///< as the system names it, or the architecture
  unsigned cores = 0;     ///< that this process may use
  std::string governor;   ///< of the first core's clock; empty: the system does not say
  std::optional<std::array<double, 3>> load;  ///< mean of runnable tasks over 1, 5 and 15 minutes
};

/// Reads it from the system.
[[nodiscard]] Machine this_machine();

/// Returns a sentence on what makes figures of this run doubtful: other work at the beginning, or a
/// fixed loop (run_fixed_loop()) whose slow runs took over 1.1 times its fast ones. Nothing on a
/// quiet machine. Precondition: `loop` is not empty.
[[nodiscard]] std::optional<std::string> noise_of(const Machine& machine, const Samples& loop);

}  // namespace ist::cli
