#include "answers/occlusion/map_colours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cli/occlusion/bites.h"

namespace ist::test {
namespace {

using answers::Bite, answers::Colour, answers::map_bands, answers::map_colour, answers::MapBand;

Bite bite_with(std::string_view preset) {
  Bite bite;
  bite.preset = &preset_of(preset);
  return bite;
}

std::vector<double> limits_of(const std::vector<MapBand>& bands) {
  std::vector<double> limits;
  for (const MapBand& band : bands) limits.push_back(std::round(1e9 * band.to) / 1e9);
  return limits;
}

std::vector<std::string> hatched(const std::vector<MapBand>& bands) {
  std::vector<std::string> words;
  for (const MapBand& band : bands) {
    if (band.below_scan_error) words.push_back(band.words);
  }
  return words;
}

TEST(MapColours, BandsFollowThePresetWithoutGaps) {
  EXPECT_EQ(limits_of(map_bands(bite_with("scan"))), (std::vector<double>{-0.05, 0, 0.1, 2}));
  EXPECT_EQ(limits_of(map_bands(bite_with("owens"))),
            (std::vector<double>{-0.05, 0, 0.05, 0.35, 2}));
  for (const answers::Preset& preset : answers::presets()) {
    const auto bands = map_bands(bite_with(preset.name));
    EXPECT_EQ(bands.front().from, -HUGE_VAL);
    for (std::size_t i = 1; i < bands.size(); ++i) EXPECT_EQ(bands[i].from, bands[i - 1].to);
    EXPECT_EQ(bands.back().to, 2);
  }
}

TEST(MapColours, LimitsAreInTheUnitOfTheMesh) {
  Bite bite = bite_with("paper");
  bite.units_per_mm = 1e-3;
  bite.contact = 1e-4;
  bite.reach = 2e-3;
  const auto bands = map_bands(bite);
  EXPECT_DOUBLE_EQ(bands[2].to, 2e-4);
  EXPECT_EQ(bands[2].words, "0 to 200 µm");
  EXPECT_EQ(bands[3].words, "200 to 2000 µm");
}

TEST(MapColours, BandsBelowTheScannerBandAreFlagged) {
  EXPECT_EQ(hatched(map_bands(bite_with("scan"))), (std::vector<std::string>{"overlap, to 50 µm"}));
  EXPECT_EQ(hatched(map_bands(bite_with("owens"))).size(), 1U) << "50 is not below 50";
  EXPECT_EQ(hatched(map_bands(bite_with("biteeye"))),
            (std::vector<std::string>{"overlap, to 50 µm", "0 to 9 µm", "9 to 29 µm"}));
  EXPECT_EQ(hatched(map_bands(bite_with("shim"))),
            (std::vector<std::string>{"overlap, to 50 µm", "0 to 10 µm"}));
  Bite bite = bite_with("biteeye");
  bite.scanner_band = 0;
  EXPECT_TRUE(hatched(map_bands(bite)).empty());
  EXPECT_EQ(map_bands(bite)[0].words, "overlap");
  EXPECT_EQ(map_bands(bite)[0].to, 0);
}

TEST(MapColours, AReachWithinTheLimitsAddsNoBand) {
  Bite bite = bite_with("stl");
  bite.reach = 0.4;
  EXPECT_EQ(map_bands(bite).back().to, 0.4);
  EXPECT_EQ(map_bands(bite).size(), 6U);
}

bool is_warm(const Colour& colour) { return colour[0] > 180 && colour[0] > colour[2] + 80; }
bool is_purple(const Colour& colour) { return colour[0] > colour[1] && colour[2] > colour[1]; }

TEST(MapColours, OverlapIsPurpleContactIsWarmTheRestIsNot) {
  for (const answers::Preset& preset : answers::presets()) {
    const auto bands = map_bands(bite_with(preset.name));
    EXPECT_TRUE(is_purple(map_colour(-3, bands)));
    EXPECT_TRUE(is_purple(map_colour(0, bands)));
    EXPECT_TRUE(is_warm(map_colour(1e-6, bands))) << preset.name;
    const double widest = preset.micrometres.back() * 1e-3;
    if (widest > 0.2) {
      EXPECT_FALSE(is_warm(map_colour(widest, bands))) << preset.name;
    }
    const Colour pale = map_colour(1.9, bands);
    EXPECT_GT(pale[0] + pale[1] + pale[2], 550);
  }
}

TEST(MapColours, ALimitBelongsToTheBandThatEndsThere) {
  const auto bands = map_bands(bite_with("owens"));
  EXPECT_EQ(map_colour(bands[2].to, bands), bands[2].colour);
  EXPECT_EQ(map_colour(std::nextafter(bands[2].to, 1), bands), bands[3].colour);
  EXPECT_EQ(map_colour(2, bands), bands[4].colour);
  EXPECT_EQ(map_colour(std::nextafter(2.0, 3), bands), answers::kBareSurface);
  EXPECT_EQ(map_colour(std::nan(""), bands), answers::kBareSurface);
}

// Vienot 1999: how the colours look without one kind of cones. 0: with all of them.
Eigen::Vector3d seen_without(char cones, const Colour& colour) {
  Eigen::Vector3d linear;
  for (int i = 0; i < 3; ++i)
    linear[i] = std::pow(colour[static_cast<std::size_t>(i)] / 255.0, 2.2);
  Eigen::Matrix3d lms, lost = Eigen::Matrix3d::Identity();
  lms << 17.8824, 43.5161, 4.11935, 3.45565, 27.1554, 3.86714, 0.0299566, 0.184309, 1.46709;
  if (cones == 'l') lost.row(0) << 0, 2.02344, -2.52581;
  if (cones == 'm') lost.row(1) << 0.494207, 0, 1.24827;
  const Eigen::Vector3d seen = lms.inverse() * lost * lms * linear;
  // CIE L*a*b*, of sRGB's white.
  Eigen::Matrix3d xyz;
  xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d relative =
      (xyz * seen.cwiseMax(0)).cwiseQuotient(Eigen::Vector3d(0.9505, 1, 1.089));
  const Eigen::Vector3d f = relative.unaryExpr([](double t) { return std::cbrt(t); });
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

TEST(MapColours, NeighboursDifferToAllEyes) {
  for (const answers::Preset& preset : answers::presets()) {
    const auto bands = map_bands(bite_with(preset.name));
    for (const char cones : {'0', 'l', 'm'}) {
      for (std::size_t i = 0; i < bands.size(); ++i) {
        const Colour next = i + 1 < bands.size() ? bands[i + 1].colour : answers::kBareSurface;
        const double differ =
            (seen_without(cones, bands[i].colour) - seen_without(cones, next)).norm();
        EXPECT_GT(differ, 12) << preset.name << " " << bands[i].words << " " << cones;
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
