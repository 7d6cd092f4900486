#pragma once

#include <cstddef>
#include <vector>

#include "cli/answers/answer.h"
#include "cli/bodies.h"
#include "cli/engine.h"

namespace ist::cli {

/// Prints one JSON object for each pose and engine: by pose, then by engine. The keys stand in
/// docs/command.md.
void print_answer_lines(const Engines& engines, const Bodies& bodies,
                        const std::vector<PoseAnswer>& answers);

/// Prints the answers for people: of one pose a line for each question, of more poses a table.
/// `timing`: with a line for each pose and engine, and its times.
void print_answers(const Engines& engines, const Bodies& bodies,
                   const std::vector<PoseAnswer>& answers, bool timing);

}  // namespace ist::cli
