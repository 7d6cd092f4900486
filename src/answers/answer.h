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

/// Returns an engine's answer at the pose of number `index` as the JSON of `ist collide`, whose
/// keys stand in docs/command.md.
[[nodiscard]] nlohmann::ordered_json answer_line(std::size_t index, const PoseAnswer& answer,
                                                 const Engine& engine, const EngineAnswer& timed,
                                                 const Bodies& bodies);

}  // namespace ist::answers
