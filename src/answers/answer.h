#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "answers/bodies.h"
#include "answers/engine.h"
#include "answers/examiner.h"

namespace ist::answers {

/// An engine's answer at one pose, and the time of each run.
struct EngineAnswer {
  QueryResult result;
  std::vector<double> microseconds;  ///< one a run, not empty

  [[nodiscard]] double fastest() const;
  [[nodiscard]] double median() const;
};

/// A pose, and the answers there.
struct PoseAnswer {
  Eigen::Isometry3d pose;
  std::optional<double> displacement;  ///< along a path, mesh units
  Findings findings;
  std::vector<EngineAnswer> engines;  ///< one for each engine
};

/// An answer about leaf pairs, and the engine that gave it.
struct LeafAnswer {
  const Engine& engine;
  const EngineAnswer& timed;
};

/// Returns the answer at the pose of number `index` as the JSON of `ist collide`, whose keys stand
/// in docs/command.md. Without voxels there are no leaf pairs, and their keys are null.
[[nodiscard]] nlohmann::ordered_json answer_line(std::size_t index, const PoseAnswer& answer,
                                                 const std::optional<LeafAnswer>& leaves,
                                                 const Bodies& bodies);

}  // namespace ist::answers
