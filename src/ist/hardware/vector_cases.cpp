#include "ist/hardware/vector_cases.h"

#include <limits>

namespace ist {

GoldenVector answered(GoldenVector vector) noexcept {
  vector.answer = test_pair(vector.pair, vector.registers);
  return vector;
}

std::optional<GoldenVector> at_distance(GoldenVector vector,
                                        const std::array<std::int64_t, 3>& distance) {
  vector.pair.moving_centre = {0, 0, 0};
  const std::array<std::int64_t, 3> from = ball_distance(vector.pair, vector.registers);
  for (std::size_t i = 0; i < 3; ++i) {
    using Limits = std::numeric_limits<std::int32_t>;
    const std::int64_t centre = distance[i] - from[i];
    if (centre < Limits::min() || centre > Limits::max()) return std::nullopt;
    vector.pair.moving_centre[i] = static_cast<std::int32_t>(centre);
  }
  return answered(vector);
}

}  // namespace ist
