#pragma once

#include <vector>

#include "ist/haptics/servo_loop.h"
#include "ist/scene.h"

namespace ist::cli {

/// Prints the built and the skipped parts of a scene with reasons, one a line.
void print_notes(const std::vector<BuildNote>& notes, bool json);

/// Prints the results of a run: latencies, deadlines, and the time of each effect.
void print_report(const ServoReport& report, const Scene& scene, const Simulation& simulation,
                  bool json);

}  // namespace ist::cli
