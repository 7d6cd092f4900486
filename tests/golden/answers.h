#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace ist::test {

/// A kind of answers that are promised to the bit, and their hash in every build.
struct GoldenAnswers {
  const char* name;
  std::uint64_t golden;
  /// Computes them by the kernels of a target, and returns their hash.
  std::uint64_t (*hash)(const std::string& target);
};

/// All kinds.
[[nodiscard]] std::span<const GoldenAnswers> golden_answers();

}  // namespace ist::test
