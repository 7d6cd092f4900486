#include "ist/voxel/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/effort.h"
#include "support/errors.h"
#include "support/random.h"

namespace ist {
namespace {

using test::error_name;
using test::error_of;

Lattice over(double x, double y, double z, double size) {
  return make_lattice({1, 2, 3}, {1 + x, 2 + y, 3 + z}, size);
}

TEST(Lattice, HasAsManyCellsAsTheLargestExtentNeeds) {
  EXPECT_EQ(over(8, 1, 1, 1).cells, 8u);
  EXPECT_EQ(over(1, 8.5, 1, 1).cells, 9u);
  EXPECT_EQ(over(1, 1, 8.0000001, 1).cells, 9u);
  EXPECT_EQ(over(0.5, 0, 0, 1).cells, 1u);
  EXPECT_EQ(over(0.5, 0, 0, 500).cells, 1u);
  EXPECT_EQ(error_name([] { (void)over(0.5, 0, 0, 501); }), "voxel-size-invalid");
  EXPECT_EQ(over(65536, 0, 0, 1).cells, 65536u);
}

TEST(Lattice, ItsCornerIsTheBoxMinimumAndItsSizeTheOneAskedFor) {
  const Lattice lattice = over(8, 1, 1, 0.3);
  EXPECT_EQ(lattice.corner, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(lattice.voxel_size, 0.3);
  EXPECT_EQ(lattice.cells, static_cast<std::uint32_t>(std::ceil(8 / 0.3)));
}

TEST(Lattice, TheRootIsTheSmallestPowerOfTwoThatHoldsTheCells) {
  for (std::uint32_t cells = 1; cells <= 4096; ++cells) {
    const int depth = over(cells, 0, 0, 1).depth;
    EXPECT_GE(1u << depth, cells);
    EXPECT_TRUE(depth == 0 || 1u << (depth - 1) < cells);
  }
  EXPECT_EQ(over(65536, 0, 0, 1).depth, 16);
}

TEST(Lattice, RefusesASizeThatIsNoPositiveNumber) {
  for (const double size : {0.0, -0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(error_name([&] { (void)over(1, 1, 1, size); }), "voxel-size-invalid") << size;
  }
}

TEST(Lattice, RefusesExtentsOfNothingAndBeyondAllMeasure) {
  const auto of_extent = [](double extent) {
    return error_name([&] { (void)make_lattice({0, 0, 0}, {0, extent, 0}, extent); });
  };
  EXPECT_EQ(of_extent(1e-12), "none");
  EXPECT_EQ(of_extent(1e15), "none");
  EXPECT_EQ(of_extent(std::nextafter(1e-12, 0)), "mesh-extent");
  EXPECT_EQ(of_extent(std::nextafter(1e15, 1e16)), "mesh-extent");
  EXPECT_EQ(error_name([] { (void)over(0, 0, 0, 1); }), "mesh-extent");
  EXPECT_EQ(error_name([] { (void)over(std::nan(""), std::nan(""), std::nan(""), 1); }),
            "mesh-extent");
  EXPECT_EQ(error_name([] { (void)over(HUGE_VAL, 0, 0, 1); }), "mesh-extent");
}

TEST(Lattice, TheSmallestSizeThatItsRefusalNamesFits) {
  test::Random random(1);
  EXPECT_EQ(error_name([] { (void)over(65536.5, 1, 1, 1); }), "voxel-size-too-small");
  for (int i = 0; i < test::samples(300); ++i) {
    const Eigen::Vector3d extents =
        std::ldexp(1.0, static_cast<int>(random.below(60)) - 20) * random.point(0.5, 1);
    const double size = extents.maxCoeff() / 65537 / (1 + random.below(1000));
    const auto error = error_of([&] { (void)make_lattice({0, 0, 0}, extents, size); });
    ASSERT_TRUE(error);
    ASSERT_EQ(error->code(), ErrorCode::kVoxelSizeTooSmall);
    const std::string what = error->what(), before = "the smallest size for this mesh is ";
    ASSERT_NE(what.find(before), std::string::npos) << what;
    const double named = std::stod(what.substr(what.find(before) + before.size()));
    EXPECT_LE(make_lattice({0, 0, 0}, extents, named).cells, 65536u);
    EXPECT_LE(named, 1.011 * extents.maxCoeff() / 65536) << "it is not the smallest";
  }
}

TEST(RoundUpForPeople, GivesThreeDigitsNeverLessAndHardlyMore) {
  test::Random random(2);
  for (int i = 0; i < test::samples(10'000); ++i) {
    const double size = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.below(80)) - 40);
    const double rounded = round_to_nice_number(size);
    EXPECT_GE(rounded, size);
    EXPECT_LE(rounded, 1.0101 * size);
    EXPECT_EQ(round_to_nice_number(rounded), rounded);
  }
  EXPECT_EQ(round_to_nice_number(0.2), 0.2);
  EXPECT_EQ(round_to_nice_number(0.2001), 0.201);
  EXPECT_EQ(round_to_nice_number(9.999), 10.0);
}

TEST(Lattice, ConvertsBetweenItsUnitsAndTheMeshs) {
  const Lattice lattice = over(8, 4, 4, 0.5);
  EXPECT_EQ(lattice.to_lattice({1, 2, 3}), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(lattice.to_lattice({9, 4, 3.25}), Eigen::Vector3d(16, 4, 0.5));
  EXPECT_EQ(lattice.root_centre(), 8.0);
  EXPECT_EQ(lattice.edge(0), 0.5);
  EXPECT_EQ(lattice.edge(3), 4.0);
  EXPECT_EQ(lattice.pad(), 1e-9 * 16);
}

}  // namespace
}  // namespace ist
