#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ist/hardware/pair_test.h"

namespace ist {

/// A test case of a circuit: its inputs, and the answer that it must give.
struct GoldenVector {
  NodePair pair;
  PairRegisters registers;
  PairAnswer answer;  ///< of the model

  friend bool operator==(const GoldenVector&, const GoldenVector&) = default;
};

/// Returns the vector with the model's answer.
[[nodiscard]] GoldenVector answered(GoldenVector vector) noexcept;

/// Returns the vector with the moving centre at which ball_distance is `distance`, and its answer;
/// nothing if that centre does not fit 32 bits.
[[nodiscard]] std::optional<GoldenVector> at_distance(GoldenVector vector,
                                                      const std::array<std::int64_t, 3>& distance);

/// Returns the cases at which a nearly correct circuit fails, always the same: masks, levels and
/// coordinates at their limits, balls that are tangent to the last bit or one bit farther apart,
/// sums that just need one more bit, registers at their extremes.
[[nodiscard]] std::vector<GoldenVector> corner_cases();

/// Generates the vectors of a seed: first the corner cases, then random ones, every other pair near
/// tangency. The sequence is the same on every machine.
class GoldenVectors {
 public:
  explicit GoldenVectors(std::uint64_t seed);

  /// Returns the next vector. Cost: 0.2 µs; does not allocate.
  [[nodiscard]] GoldenVector next();

 private:
  [[nodiscard]] std::uint64_t bits() noexcept;
  [[nodiscard]] std::uint32_t below(std::uint32_t end) noexcept;
  [[nodiscard]] double between(double low, double high) noexcept;
  [[nodiscard]] GoldenVector random_vector(bool near);
  [[nodiscard]] PairRegisters random_registers();

  std::vector<GoldenVector> corners_;
  std::size_t given_ = 0;
  std::uint64_t state_;
};

}  // namespace ist
