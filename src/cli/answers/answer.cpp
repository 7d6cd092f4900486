#include "cli/answers/answer.h"

#include <algorithm>

namespace ist::cli {

double EngineAnswer::fastest() const {
  return *std::min_element(microseconds.begin(), microseconds.end());
}

double EngineAnswer::median() const {
  std::vector<double> sorted = microseconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

}  // namespace ist::cli
