#pragma once

#include <vector>

#include "ist/haptics/servo_loop.h"
#include "ist/scene/scene_builder.h"

namespace ist::cli {

/// Prints what of a scene is built and what is not, and why: a line each.
void print_notes(const std::vector<BuildNote>& notes, bool json);

/// Prints what a run came to: latencies, deadlines, and what each effect took.
void print_report(const ServoReport& report, const Scene& scene, const Simulation& simulation,
                  bool json);

}  // namespace ist::cli
