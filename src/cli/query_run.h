#pragma once

#include <Eigen/Geometry>
#include <span>

#include "cli/bodies.h"
#include "cli/query_options.h"

namespace ist::cli {

/// Runs every engine at every pose, `repeat` times round the whole list with the engines in turn,
/// and prints a line for each pose and engine; writes the first engine's leaf pairs and contacts if
/// a file is named. With --verify, runs each engine at each pose once more and checks those answers
/// before a line is printed or the file appears.
void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options);

}  // namespace ist::cli
