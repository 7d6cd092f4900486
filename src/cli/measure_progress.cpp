#include "cli/measure_progress.h"

#include <algorithm>
#include <cstdint>

namespace ist::cli {

Proceed shown_by(Progress& progress, const char* stage) {
  constexpr double kSteps = 1000;
  progress.begin_stage(stage, static_cast<std::uint64_t>(kSteps));
  return [&progress, told = std::uint64_t{0}](double part) mutable {
    const std::uint64_t done = std::max(told, static_cast<std::uint64_t>(kSteps * part));
    progress.add(done - told);
    told = done;
    return true;
  };
}

}  // namespace ist::cli
