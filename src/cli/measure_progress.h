#pragma once

#include "ist/base/progress.h"

namespace ist::cli {

/// Begins a stage of a measure, and returns what the measure tells its progress. `progress` must
/// outlive it.
[[nodiscard]] Proceed shown_by(Progress& progress, const char* stage);

}  // namespace ist::cli
