#include "answers/occlusion/map_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ist/base/assert.h"

namespace ist::answers {
namespace {

// Overlap, from the deepest to touch; distances, from touch to the farthest; changes, from nearer
// to farther. The first two have the hues of the bands.
constexpr std::array<Colour, 2> kOverlapRamp{{{104, 28, 132}, {214, 76, 150}}};
constexpr std::array<Colour, 6> kDistanceRamp{{{196, 54, 22},
                                               {244, 142, 40},
                                               {255, 222, 96},
                                               {176, 212, 84},
                                               {72, 172, 172},
                                               {56, 104, 184}}};
constexpr std::array<Colour, 5> kChangeRamp{
    {{178, 24, 43}, {244, 165, 130}, {247, 247, 247}, {146, 197, 222}, {33, 102, 172}}};

// The colour at a part of the way along a ramp, 0 to 1.
Colour at_part(std::span<const Colour> ramp, double part) {
  const double place = std::clamp(part, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
  const auto stop = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
  const double rest = place - static_cast<double>(stop);
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = ramp[stop][i], to = ramp[stop + 1][i];
    colour[i] = static_cast<std::uint8_t>(std::lround(from + rest * (to - from)));
  }
  return colour;
}

}  // namespace

MapScale MapScale::of_bands(std::vector<MapBand> bands) {
  MapScale scale;
  scale.bands_ = std::move(bands);
  return scale;
}

MapScale MapScale::of_distances(double low, double high) {
  IST_ASSERT(low < high && high > 0);
  MapScale scale;
  scale.ramp_ = Ramp::kDistances;
  scale.low_ = low;
  scale.high_ = high;
  return scale;
}

MapScale MapScale::of_changes(double most) {
  IST_ASSERT(most > 0);
  MapScale scale;
  scale.ramp_ = Ramp::kChanges;
  scale.low_ = -most;
  scale.high_ = most;
  return scale;
}

Colour MapScale::colour(double number) const {
  if (std::isnan(number)) return kBareSurface;
  if (ramp_ == Ramp::kBands) return map_colour(number, bands_);
  if (ramp_ == Ramp::kChanges) return at_part(kChangeRamp, (number - low_) / (high_ - low_));
  if (number > high_) return kBareSurface;
  const double from = std::max(low_, 0.0);
  return number <= 0 && low_ < 0 ? at_part(kOverlapRamp, 1 - number / low_)
                                 : at_part(kDistanceRamp, (number - from) / (high_ - from));
}

bool MapScale::is_hatched(double number) const {
  const MapBand* band = band_of(number, bands_);
  return band != nullptr && band->below_scan_error;
}

double round_step(double number) {
  const double ten = std::pow(10, std::floor(std::log10(number)));
  for (const double step : {5.0, 2.0}) {
    if (step * ten <= number) return step * ten;
  }
  return ten;
}

}  // namespace ist::answers
