#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "cli/answers/answer.h"
#include "cli/bodies.h"
#include "cli/engine.h"

namespace ist::cli {

/// Returns an engine's answer at the pose of number `index` as the JSON of `ist collide`, whose
/// keys stand in docs/command.md.
[[nodiscard]] nlohmann::ordered_json answer_line(std::size_t index, const PoseAnswer& answer,
                                                 const Engine& engine, const EngineAnswer& timed,
                                                 const Bodies& bodies);

}  // namespace ist::cli
