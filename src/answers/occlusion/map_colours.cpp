#include "answers/occlusion/map_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ist::answers {
namespace {

// Neighbours differ in lightness, or in blue against yellow, so that they differ to all eyes. Cool
// colours are apart, warm ones touch, and purple overlaps.
constexpr Colour kDeep{104, 28, 132}, kOverlap{196, 52, 132};
constexpr std::array<Colour, 3> kContact{{{196, 54, 22}, {244, 142, 40}, {255, 222, 96}}};
constexpr std::array<Colour, 3> kNear{{{176, 212, 84}, {72, 172, 172}, {56, 104, 184}}};
constexpr Colour kBeyond{188, 206, 230};

Colour mixed(const Colour& a, const Colour& b, double part) {
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    colour[i] = static_cast<std::uint8_t>(std::lround(a[i] + part * (b[i] - a[i])));
  }
  return colour;
}

// The `i`-th of so many colours along a ramp, which begin at its beginning.
Colour along(const std::array<Colour, 3>& ramp, std::size_t i, std::size_t count) {
  if (i == 0) return ramp[0];
  const double place = 2.0 * static_cast<double>(i) / static_cast<double>(count - 1);
  const std::size_t stop = std::min<std::size_t>(static_cast<std::size_t>(place), 1);
  return mixed(ramp[stop], ramp[stop + 1], place - static_cast<double>(stop));
}

}  // namespace

std::vector<MapBand> map_bands(const Bite& bite) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const double unit = bite.units_per_micrometre(), band = bite.scanner_band;
  std::vector<MapBand> bands;
  if (band > 0) {
    bands.push_back(
        {-kEndless, -band * unit, kDeep, fmt::format("overlap, deeper than {:g} µm", band), false});
    bands.push_back({-band * unit, 0, kOverlap, fmt::format("overlap, to {:g} µm", band), true});
  } else {
    bands.push_back({-kEndless, 0, kOverlap, "overlap", false});
  }
  std::vector<double> limits;  // micrometres
  for (const double limit : bite.preset->micrometres) {
    if (limit > 0) limits.push_back(limit);
  }
  // The first band touches, whatever the preset means by touching.
  const double contact = std::max(bite.contact / unit * (1 + 1e-9), limits.empty() ? 0 : limits[0]);
  const auto touching = static_cast<std::size_t>(
      std::upper_bound(limits.begin(), limits.end(), contact) - limits.begin());
  double from = 0;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const bool touches = i < touching;
    // A single near band is halfway, and as far as can be from what touches.
    const std::size_t near = limits.size() - touching;
    const Colour colour = touches     ? along(kContact, i, touching)
                          : near == 1 ? kNear[1]
                                      : along(kNear, i - touching, near);
    bands.push_back({from * unit, limits[i] * unit, colour,
                     fmt::format("{:g} to {:g} µm", from, limits[i]), limits[i] < band});
    from = limits[i];
  }
  if (bite.reach > from * unit) {
    bands.push_back({from * unit, bite.reach, kBeyond,
                     fmt::format("{:g} to {:g} µm", from, bite.reach / unit), false});
  }
  return bands;
}

const MapBand* band_of(double distance, std::span<const MapBand> bands) {
  // Of NaN no band is.
  const auto at = std::find_if(bands.begin(), bands.end(),
                               [distance](const MapBand& band) { return distance <= band.to; });
  return at == bands.end() ? nullptr : &*at;
}

Colour map_colour(double distance, std::span<const MapBand> bands) {
  const MapBand* band = band_of(distance, bands);
  return band == nullptr ? kBareSurface : band->colour;
}

}  // namespace ist::answers
