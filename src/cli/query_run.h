#pragma once

#include <Eigen/Geometry>
#include <span>

#include "cli/bodies.h"
#include "cli/query_options.h"

namespace ist::cli {

/// Asks every engine every pose, `repeat` times round the whole list with the engines in turn, and
/// prints a line for each pose and engine; writes the first engine's contacts where they are asked
/// for. With --verify each engine is then asked each pose once more, and those answers are checked
/// before a line is printed or the contacts' file is there.
void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options);

}  // namespace ist::cli
