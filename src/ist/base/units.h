#pragma once

#include <optional>
#include <string_view>

namespace ist {

/// Metres in a unit of length: "m", "cm", "mm", "um" or "inch"; nothing for another name.
[[nodiscard]] constexpr std::optional<double> metres_in(std::string_view unit) noexcept {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  if (unit == "um") return 1e-6;
  if (unit == "inch") return 0.0254;
  return std::nullopt;
}

}  // namespace ist
