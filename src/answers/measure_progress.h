#pragma once

#include <algorithm>
#include <cstdint>

#include "ist/base/progress.h"

namespace ist::answers {

/// Begins a stage of a measure, and returns the function that the measure tells its progress.
/// `progress` must outlive the function.
[[nodiscard]] inline Proceed shown_by(Progress& progress, const char* stage) {
  constexpr double kSteps = 1000;
  progress.begin_stage(stage, static_cast<std::uint64_t>(kSteps));
  return [&progress, told = std::uint64_t{0}](double part) mutable {
    const std::uint64_t done = std::max(told, static_cast<std::uint64_t>(kSteps * part));
    progress.add(done - told);
    told = done;
    return true;
  };
}

}  // namespace ist::answers
