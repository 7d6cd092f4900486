#include "cli/occlusion/map_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "cli/occlusion/bites.h"
#include "cli/occlusion/figure/canvas.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::Bite, cli::BiteView, cli::BiteViews, answers::Colour, cli::draw_map, cli::Picture;
using Vector = Eigen::Vector3d;

constexpr int kWidth = 450, kHeight = 350;

void expect_frame(const BiteView& view) {
  EXPECT_NEAR(view.across.norm(), 1, 1e-12);
  EXPECT_NEAR(view.up.norm(), 1, 1e-12);
  EXPECT_TRUE(view.across.cross(view.up).isApprox(view.towards, 1e-12)) << "no mirror";
}

TEST(BiteView, LooksFromTheOtherBodyAndOpensLikeABook) {
  const auto made = sphere_over_plate({0, 0, -0.05});
  const BiteViews views = cli::bite_views(made->bite, kWidth, kHeight);
  expect_frame(views.fixed);
  expect_frame(views.moving);
  EXPECT_EQ(views.fixed.towards, Vector::UnitZ());
  EXPECT_EQ(views.moving.towards, -Vector::UnitZ());
  EXPECT_EQ(views.fixed.across, Vector::UnitX()) << "the first side ends the lines";
  EXPECT_EQ(views.moving.across, Vector::UnitX());
  EXPECT_EQ(views.fixed.up, Vector::UnitY());
  EXPECT_EQ(views.moving.up, -Vector::UnitY());
  EXPECT_EQ(views.fixed.pixel, views.moving.pixel);
}

TEST(BiteView, TurnsWithTheSidesAndSwapsWithTheBodies) {
  auto made = sphere_over_plate({0, 0, -0.05});
  made->bite.sides.direction = -Vector::UnitY();
  EXPECT_EQ(cli::bite_views(made->bite, kWidth, kHeight).fixed.across, -Vector::UnitY());
  made->bite.sides.direction = Vector::UnitZ();  // along the view: the other division runs across
  EXPECT_EQ(cli::bite_views(made->bite, kWidth, kHeight).fixed.across, Vector::UnitY());
  std::swap(made->bite.fixed, made->bite.moving);
  EXPECT_EQ(cli::bite_views(made->bite, kWidth, kHeight).fixed.towards, -Vector::UnitZ());
}

TEST(BiteView, HoldsBothBodiesOrWhereTheyFaceEachOther) {
  const auto near = sphere_over_plate({0, 0, 0.5});
  const auto far = sphere_over_plate({0, 0, 5});  // nothing within the reach
  const BiteView view = cli::bite_views(far->bite, kWidth, kHeight).fixed;
  EXPECT_EQ(view.towards, Vector::UnitZ());
  for (const Vector& v : far->bite.fixed.mesh->vertices) {
    const Eigen::Vector2d place = cli::place_in(view, kWidth, kHeight, v);
    EXPECT_TRUE(place.x() > 0 && place.x() < kWidth && place.y() > 0 && place.y() < kHeight);
  }
  // Within the reach lies a cap, a third as wide as the plate.
  const BiteView closer = cli::bite_views(near->bite, kWidth, kHeight).fixed;
  EXPECT_LT(closer.pixel, 0.8 * view.pixel);
  EXPECT_GE(closer.pixel, view.pixel / 3);
  const auto aside = sphere_over_plate({5, 0, -0.05});
  const BiteView there = cli::bite_views(aside->bite, kWidth, kHeight).fixed;
  EXPECT_NEAR(there.middle.x(), 5, 0.3);
}

TEST(BiteView, OfATiltedBiteIsTilted) {
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.6, Vector::UnitX()));
  const auto made = bite_of(turned(plate(10, 0.5), turn.linear()), icosphere(4, 4),
                            turn * Eigen::Translation3d(0, 0, 3.95));
  const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
  EXPECT_GT(view.towards.dot(turn * Vector::UnitZ()), 0.9999);
  EXPECT_LT(view.towards.z(), 0.9);
}

// A sphere of radius 4 over a plate: the distance of a point of the plate from it.
double distance_at(const Vector& point, const Vector& lowest) {
  return (point - lowest - Vector(0, 0, 4)).norm() - 4;
}

// How many pixels have the colour of a band, but for hatching and dots, over how many have its
// distance: all of the plate that is no border between bands.
TEST(MapPicture, PlateUnderASphereHasTheColoursOfItsDistances) {
  for (const char* preset : {"scan", "stl"}) {
    const Vector lowest(1, -2, -0.2);
    auto made = sphere_over_plate(lowest, preset);
    made->bite.scanner_band = 0;  // nothing is hatched
    const auto bands = answers::map_bands(made->bite);
    const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
    const Picture picture = draw_map(made->bite.fixed, view, bands, kWidth, kHeight);
    std::map<Colour, int> seen;
    int wrong = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Vector point = view.middle + view.pixel * ((x + 0.5 - 0.5 * kWidth) * view.across -
                                                         (y + 0.5 - 0.5 * kHeight) * view.up);
        const double distance = distance_at({point.x(), point.y(), 0}, lowest);
        const Colour expected = answers::map_colour(distance, bands);
        const bool border = answers::map_colour(distance - 0.1, bands) != expected ||
                            answers::map_colour(distance + 0.1, bands) != expected;
        const bool dot = (point - lowest).head<2>().norm() < 6 * view.pixel;
        if (distance > 1.7 || border || dot) continue;
        ++seen[expected];
        if (pixel_at(picture, x, y) != expected) ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(seen.size(), 2U) << preset;
    EXPECT_GT(seen[bands.front().colour], 20);
    EXPECT_GT(seen[bands.back().colour], 500);
  }
}

TEST(MapPicture, BandsBelowTheScannerBandAreHatched) {
  auto made = sphere_over_plate({0, 0, -0.04});  // it overlaps by less than 50 µm
  const auto count = [&](const Colour& colour) {
    const auto bands = answers::map_bands(made->bite);
    const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
    const Picture picture = draw_map(made->bite.fixed, view, bands, kWidth, kHeight);
    int pixels = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) pixels += pixel_at(picture, x, y) == colour ? 1 : 0;
    }
    return pixels;
  };
  const Colour white{255, 255, 255}, overlap = answers::map_bands(made->bite)[1].colour;
  const int hatched = count(overlap), white_with = count(white);
  made->bite.scanner_band = 0;
  const int plain = count(overlap), white_without = count(white);
  EXPECT_GT(hatched, plain / 3);
  EXPECT_LT(hatched, plain * 0.8);
  EXPECT_GT(white_with, white_without + plain / 10);
}

TEST(MapPicture, DotsShowTheClosestPointsAndWhetherTheyAreOnBothBodies) {
  auto made = sphere_over_plate({1, -2, -0.2});
  ASSERT_EQ(made->bite.fixed.surface.regions.size(), 1U);
  const auto bands = answers::map_bands(made->bite);
  const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
  const auto dot = [&] {
    const Picture picture = draw_map(made->bite.fixed, view, bands, kWidth, kHeight);
    const Eigen::Vector2d place =
        cli::place_in(view, kWidth, kHeight, made->bite.fixed.surface.regions[0].closest);
    return pixel_at(picture, static_cast<int>(place.x()), static_cast<int>(place.y()));
  };
  ASSERT_EQ(made->bite.fixed.on_both, 1U);
  EXPECT_LT(dot()[1], 10);
  made->bite.fixed.on_both = 0;
  EXPECT_GT(dot()[1], 245);
}

TEST(MapPicture, StaysBareWhereTheDistanceIsUnknownOrASignIsWrong) {
  auto made = sphere_over_plate({0, 0, 0.5});
  made->bite.scanner_band = 0;
  answers::BiteBody& body = made->bite.fixed;
  const auto bands = answers::map_bands(made->bite);
  const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
  const auto middle = [&] {
    return pixel_at(draw_map(body, view, bands, kWidth, kHeight), kWidth / 2, kHeight / 2);
  };
  EXPECT_EQ(middle(), bands.back().colour);
  std::size_t nearest = 0;
  for (std::size_t v = 0; v < body.mesh->vertices.size(); ++v) {
    if (body.mesh->vertices[v].norm() < body.mesh->vertices[nearest].norm()) nearest = v;
  }
  double& distance = body.surface.vertices[nearest].distance;
  for (const double bad : {-distance, std::nan("")}) {
    const double good = std::exchange(distance, bad);
    EXPECT_EQ(middle(), answers::kBareSurface);
    distance = good;
  }
}

TEST(MapPicture, ShowsTheSurfaceNearestToTheEyeAndInnerSidesGrey) {
  auto made = sphere_over_plate({0, 0, -0.2});
  const auto bands = answers::map_bands(made->bite);
  const BiteView view = cli::bite_views(made->bite, kWidth, kHeight).fixed;
  // From above the sphere hides its own contact.
  const Picture above = draw_map(made->bite.moving, view, bands, kWidth, kHeight);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(pixel_at(above, kWidth / 2, kHeight / 2)[i], answers::kBareSurface[i], 2);
  }
  BiteView below = view;
  below.up = -below.up;
  below.towards = -below.towards;
  const Colour inner =
      pixel_at(draw_map(made->bite.fixed, below, bands, kWidth, kHeight), kWidth / 4, 20);
  EXPECT_LT(std::abs(inner[0] - inner[2]), 20);
  EXPECT_LT(inner[0], 160);
}

TEST(PngImage, HoldsEveryPixel) {
  Picture picture{37, 5, {}};
  for (int i = 0; i < 3 * 37 * 5; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(i * i));
  const Picture read = decoded(cli::png_of(picture));
  EXPECT_EQ(read.width, 37);
  EXPECT_EQ(read.height, 5);
  EXPECT_EQ(read.rgb, picture.rgb);
  EXPECT_THROW((void)decoded(cli::png_of(picture).substr(0, 60)), std::runtime_error);
}

}  // namespace
}  // namespace ist::test
