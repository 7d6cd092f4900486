#pragma once

#include <Eigen/Geometry>
#include <span>

#include "cli/bodies.h"
#include "cli/query_options.h"

namespace ist::cli {

/// Asks every pose of every engine, `repeat` times round the whole list with the engines in turn,
/// and prints a line for each pose and engine; writes the contacts where they are asked for. With
/// --verify each engine is asked once more and that answer checked, before anything is printed or
/// written.
void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options);

}  // namespace ist::cli
