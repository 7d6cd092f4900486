#pragma once

#include <limits>

namespace ist {

/// Returns a float that is no less than `value`, and hardly more. `value` is not negative.
[[nodiscard]] inline float rounded_up(double value) noexcept {
  return static_cast<float>(value * (1 + 0x1p-22)) + std::numeric_limits<float>::min();
}

}  // namespace ist
