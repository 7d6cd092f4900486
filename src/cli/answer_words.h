#pragma once

#include <vector>

#include "answers/answer.h"
#include "answers/bodies.h"
#include "answers/engine.h"

namespace ist::cli {

/// Prints one JSON object for each pose and engine: by pose, then by engine. The keys stand in
/// docs/command.md.
void print_answer_lines(const answers::Engines& engines, const answers::Bodies& bodies,
                        const std::vector<answers::PoseAnswer>& answers);

/// Prints the answers for people: of one pose a line for each question, of more poses a table.
/// `timing`: with a line for each pose and engine, and its times.
void print_answers(const answers::Engines& engines, const answers::Bodies& bodies,
                   const std::vector<answers::PoseAnswer>& answers, bool timing);

}  // namespace ist::cli
