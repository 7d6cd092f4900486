#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "answers/comparison/comparison_files.h"
#include "answers/occlusion/bite_files.h"
#include "cli/occlusion/bites.h"
#include "cli/occlusion/figure/bite_figure.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using cli::FigureKind, answers::MapScale;

std::string drawn(const answers::Bite& bite, const MapScale& scale, FigureKind kind) {
  const TempDir folder;
  const std::filesystem::path path = folder.path() / "figure";
  OutputFile file(path);
  cli::write_bite_figure(bite, scale, kind, file);
  file.commit();
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

int pixels_of(const cli::Picture& picture, const answers::Colour& colour) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      count += pixel_at(picture, x, y) == colour ? 1 : 0;
    }
  }
  return count;
}

TEST(BiteFigure, Png_Has170MillimetresAt300DotsPerInch) {
  const auto made = sphere_over_plate({0, 0, -0.1}, "stl");
  const std::string png = drawn(made->bite, cli::scale_of(made->bite, {}), FigureKind::kPng);
  const cli::Picture picture = decoded(png);
  EXPECT_NEAR(picture.width, 170 / 25.4 * 300, 5);
  // 300 dots per inch are 11,811 per metre.
  EXPECT_EQ(png.substr(37, 13), std::string("pHYs\0\0\x2E\x23\0\0\x2E\x23\1", 13));
  for (const answers::MapBand& band : answers::map_bands(made->bite)) {
    EXPECT_GT(pixels_of(picture, band.colour), 300) << band.words;
  }
}

TEST(BiteFigure, SameBite_GivesSameBytes) {
  const auto made = sphere_over_plate({0, 0, -0.1});
  const MapScale scale = cli::scale_of(made->bite, {.continuous = true});
  for (const FigureKind kind : {FigureKind::kPng, FigureKind::kPdf}) {
    EXPECT_EQ(drawn(made->bite, scale, kind), drawn(made->bite, scale, kind));
  }
  EXPECT_TRUE(drawn(made->bite, scale, FigureKind::kPdf).starts_with("%PDF-1."));
  const std::string svg = drawn(made->bite, scale, FigureKind::kSvg);
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST(BiteFigure, Range_ChangesNoColourWithTheBite) {
  const auto near = sphere_over_plate({0, 0, 0.1}), far = sphere_over_plate({0, 0, 0.5});
  const cli::FigureOptions series{.continuous = true, .range = std::pair(-0.2, 1.0)};
  for (const double at : {-0.3, -0.1, 0.05, 0.7, 1.5}) {
    EXPECT_EQ(cli::scale_of(near->bite, series).colour(at),
              cli::scale_of(far->bite, series).colour(at));
  }
  EXPECT_EQ(cli::scale_of(near->bite, {.continuous = true}).high(), near->bite.reach);
}

TEST(BiteFigure, WithoutContactOrMap_IsDrawn) {
  for (const double height : {1.0, 50.0}) {
    const auto made = sphere_over_plate({0, 0, height});
    EXPECT_TRUE(made->bite.contacts.empty());
    for (const bool continuous : {false, true}) {
      const MapScale scale = cli::scale_of(made->bite, {.continuous = continuous});
      EXPECT_GT(decoded(drawn(made->bite, scale, FigureKind::kPng)).height, 1000);
    }
  }
}

TEST(ChangeFigure, OfANearerBall_IsRed) {
  const auto before = sphere_over_plate({0, 0, 0.05}), after = sphere_over_plate({0, 0, -0.2});
  answers::BiteComparison comparison;
  comparison.before = answers::record_of(answers::json_of(before->bite), "before");
  comparison.after = answers::record_of(answers::json_of(after->bite), "after");
  answers::compare(comparison);
  const answers::ChangeMap map = answers::change_map(before->bite, after->bite);
  const TempDir folder;
  const std::filesystem::path path = folder.path() / "figure";
  OutputFile file(path);
  const MapScale scale = cli::scale_of(map, 2, 0.25);
  cli::write_change_figure(after->bite, comparison, map, scale, FigureKind::kPng, file);
  file.commit();
  std::ifstream stream(path, std::ios::binary);
  const cli::Picture picture = decoded(std::string(std::istreambuf_iterator<char>(stream), {}));
  EXPECT_GT(pixels_of(picture, scale.colour(-0.25)), 1000);
}

}  // namespace
}  // namespace ist::test
