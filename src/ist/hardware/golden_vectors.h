#pragma once

#include <cstdint>
#include <vector>

#include "ist/hardware/pair_test.h"

namespace ist {

/// What a circuit is given, and what it must answer.
struct GoldenVector {
  NodePair pair;
  PairRegisters registers;
  PairAnswer answer;  ///< the model's

  friend bool operator==(const GoldenVector&, const GoldenVector&) = default;
};

/// The cases at which a circuit that is nearly right goes wrong, always the same: masks, levels and
/// coordinates at their ends, balls that touch to the last bit and those a bit beyond, sums that
/// just need one bit more, registers at their extremes.
[[nodiscard]] std::vector<GoldenVector> corner_cases();

/// Vectors of a seed: first the corner cases, then random ones, of which every other pair is near
/// contact. The same everywhere.
class GoldenVectors {
 public:
  explicit GoldenVectors(std::uint64_t seed);

  /// Cost: 0.2 µs; does not allocate.
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
