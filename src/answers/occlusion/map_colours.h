#pragma once

#include <span>
#include <string>
#include <vector>

#include "answers/formats/poly_data.h"
#include "answers/occlusion/bite.h"

namespace ist::answers {

/// A band of a distance map: distances above `from` to `to`, mesh units.
struct MapBand {
  double from, to;
  Colour colour;
  std::string words;      ///< for the legend, such as "0 to 100 µm"
  bool below_scan_error;  ///< drawn hatched: "below the error assumed for scanning"
};

/// Returns the bands of a bite, by distance and without gaps: two of overlap, by more and by less
/// than the scanner band, one for each limit of the preset over 0, and one to the reach. Touch is
/// warm, near distances go from green to blue, and the last band is pale.
[[nodiscard]] std::vector<MapBand> map_bands(const Bite& bite);

/// Returns the band of a signed distance; null for NaN, and beyond the bands. A limit belongs to
/// the band that ends there.
[[nodiscard]] const MapBand* band_of(double distance, std::span<const MapBand> bands);

/// Returns the colour of a signed distance, or kBareSurface for NaN and beyond the bands.
[[nodiscard]] Colour map_colour(double distance, std::span<const MapBand> bands);

inline constexpr Colour kBareSurface{214, 208, 196};

}  // namespace ist::answers
