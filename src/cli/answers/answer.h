#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "cli/answers/examiner.h"
#include "cli/engine.h"

namespace ist::cli {

/// An engine's answer at one pose, and the time of each run.
struct EngineAnswer {
  QueryResult result;
  std::vector<double> microseconds;  ///< one a run, not empty

  [[nodiscard]] double fastest() const;
  [[nodiscard]] double median() const;
};

/// A pose, and all that is known there.
struct PoseAnswer {
  Eigen::Isometry3d pose;
  std::optional<double> displacement;  ///< along a path, mesh units
  Findings findings;
  std::vector<EngineAnswer> engines;  ///< one for each engine
};

}  // namespace ist::cli
