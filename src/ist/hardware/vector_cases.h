#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "ist/hardware/golden_vectors.h"

/// What corner cases and random vectors are made with.
namespace ist {

/// The vector with the moving centre at which ball_distance is `distance`, and its answer; nothing
/// where no centre of 32 bits is there.
[[nodiscard]] std::optional<GoldenVector> at_distance(GoldenVector vector,
                                                      const std::array<std::int64_t, 3>& distance);

/// With its answer.
[[nodiscard]] GoldenVector answered(GoldenVector vector) noexcept;

}  // namespace ist
