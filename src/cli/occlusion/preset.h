#pragma once

#include <span>
#include <string_view>

namespace ist::cli {

/// Limits of distance by which an occlusion is told, from a publication or a product. None of them
/// is a clinical recommendation.
struct Preset {
  std::string_view name;
  std::span<const double> micrometres;  ///< the limits, increasing; 0 is where surfaces meet
  std::string_view source;              ///< where the limits are from, and of what they were made
};

/// Returns all presets, the default first.
[[nodiscard]] std::span<const Preset> presets();

}  // namespace ist::cli
