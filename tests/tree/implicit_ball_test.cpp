#include "ist/tree/implicit_ball.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ist/tree/saved_spheres.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

using test::ExactBox;
using test::ExactPoint;

Lattice lattice_of(int depth, double voxel_size) {
  Lattice lattice;
  lattice.depth = depth;
  lattice.cells = 1u << std::min(depth, 16);
  lattice.voxel_size = voxel_size;
  return lattice;
}

// The corners of what a ball must hold: the node's cube, or those of its children.
std::vector<ExactPoint> corners_to_hold(const Lattice& lattice, SpherePolicy policy, int level,
                                        std::uint64_t code, unsigned mask) {
  std::vector<ExactBox> cubes;
  if (level == 0 || policy == SpherePolicy::kSimple) {
    cubes.push_back(test::node_cube(lattice, level, code));
  } else {
    for (std::uint64_t child = 0; child < 8; ++child) {
      if ((mask >> child & 1) != 0) {
        cubes.push_back(test::node_cube(lattice, level - 1, code * 8 + child));
      }
    }
  }
  std::vector<ExactPoint> corners;
  const ExactPoint origin = test::frame_origin(lattice);
  for (const ExactBox& cube : cubes) {
    for (int corner = 0; corner < 8; ++corner) {
      ExactPoint p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = ((corner >> axis & 1) != 0 ? cube.high[axis] : cube.low[axis]) - origin[axis];
      }
      corners.push_back(p);
    }
  }
  return corners;
}

// Holds the cubes and is the smallest that does, but for `slack`.
void expect_the_smallest_ball(const Lattice& lattice, SpherePolicy policy, int level,
                              std::uint64_t code, std::uint8_t mask, double slack) {
  const Ball ball = implicit_ball(policy, lattice, level, cube_centre(lattice, level, code), mask);
  const auto corners = corners_to_hold(lattice, policy, level, code, mask);
  const ExactPoint centre = test::exact(ball.centre);
  const mpq_class enough = mpq_class(ball.radius) + mpq_class(slack);
  for (const ExactPoint& corner : corners) {
    EXPECT_LE(test::square(corner - centre), enough * enough) << level << ' ' << int{mask};
  }
  const double smallest = std::sqrt(test::smallest_ball(corners).radius_squared.get_d());
  EXPECT_LE(ball.radius, smallest * (1 + 4e-16) + slack);
}

// A voxel size that is a power of two rounds nothing. The table's centres have thirds of a half
// edge, which are rounded.
TEST(ImplicitBall, HoldsTheCubesExactlyWhereTheVoxelSizeIsAPowerOfTwo) {
  const Lattice lattice = lattice_of(10, 0.25);
  test::Random random(1);
  for (int i = 0; i < test::samples(200); ++i) {
    const int level = static_cast<int>(random.below(11));
    const std::uint64_t code = random.bits() % (std::uint64_t{1} << 3 * (10 - level));
    expect_the_smallest_ball(lattice, SpherePolicy::kSimple, level, code, 255, 0);
    const unsigned octant = random.below(8);
    const auto one = static_cast<std::uint8_t>(1u << octant);
    expect_the_smallest_ball(lattice, SpherePolicy::kTable, level, code, one, 1e-15 * 512);
  }
}

TEST(ImplicitBall, OfEveryMaskIsTheSmallestRoundTheChildrensCubes) {
  const Lattice lattice = lattice_of(3, 0.2);
  const double slack = 0x1p-51 * lattice.edge(3);
  for (unsigned mask = 1; mask < 256; ++mask) {
    for (int level = 1; level <= 3; ++level) {
      const std::uint64_t code = (mask * 73) % (std::uint64_t{1} << 3 * (3 - level));
      expect_the_smallest_ball(lattice, SpherePolicy::kTable, level, code,
                               static_cast<std::uint8_t>(mask), slack);
    }
  }
}

TEST(ImplicitBall, HoldsTheCubesToARoundingOfTheGridsExtentAtAnySize) {
  test::Random random(2);
  for (int i = 0; i < test::samples(300); ++i) {
    const int depth = static_cast<int>(random.below(17));
    const Lattice lattice = lattice_of(
        depth, std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.below(40)) - 20));
    const int level = static_cast<int>(random.below(static_cast<std::uint32_t>(depth) + 1));
    const std::uint64_t code = random.bits() % (std::uint64_t{1} << 3 * (depth - level));
    const auto mask = static_cast<std::uint8_t>(1 + random.below(255));
    const double slack = 0x1p-51 * lattice.edge(depth);
    for (const auto policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
      expect_the_smallest_ball(lattice, policy, level, code, mask, slack);
    }
  }
}

TEST(ImplicitBall, OfALeafIsTheCircumsphereWhateverTheMask) {
  const Lattice lattice = lattice_of(2, 1);
  for (const std::uint8_t mask : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{255}}) {
    const Ball ball =
        implicit_ball(SpherePolicy::kTable, lattice, 0, cube_centre(lattice, 0, 5), mask);
    EXPECT_EQ(ball.radius, 0.5 * kSqrt3);
    EXPECT_EQ(ball.centre, Eigen::Vector3d(-0.5, -1.5, -0.5));
  }
}

// How many leaves of a node at `level` were looked at: all, or above level 3 those in the corners
// of its children's cubes. The circumsphere of each lies in the node's ball, to within `slack`.
std::size_t expect_holds_its_leaves(const Lattice& lattice, SpherePolicy policy, int level,
                                    std::uint64_t code, std::uint8_t mask, double slack) {
  const Ball ball = nested_ball(policy, lattice, level, cube_centre(lattice, level, code), mask);
  const std::uint64_t in_child = std::uint64_t{1} << 3 * (level - 1);
  const std::uint64_t places = level <= 3 ? in_child : 8;
  const std::uint64_t apart = level <= 3 ? 1 : (in_child - 1) / 7;
  std::size_t leaves = 0;
  for (std::uint64_t child = 0; child < 8; ++child) {
    if ((mask >> child & 1) == 0) continue;
    for (std::uint64_t place = 0; place < places; ++place, ++leaves) {
      const std::uint64_t leaf = (code * 8 + child) * in_child + place * apart;
      const Ball inner = nested_ball(policy, lattice, 0, cube_centre(lattice, 0, leaf), 0);
      const mpq_class room = mpq_class(ball.radius) + mpq_class(slack) - mpq_class(inner.radius);
      EXPECT_GE(room, 0);
      EXPECT_LE(test::square(test::exact(inner.centre) - test::exact(ball.centre)), room * room)
          << "leaf " << leaf << ", level " << level << ", mask " << int{mask};
    }
  }
  return leaves;
}

TEST(NestedBall, OfEveryMaskHoldsTheCircumspheresOfAllLeaves) {
  std::size_t leaves = 0;
  for (unsigned mask = 1; mask < 256; ++mask) {
    for (int level = 1; level <= 8; ++level) {
      const Lattice lattice = lattice_of(level + 1, 0.3);
      for (const auto policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
        leaves += expect_holds_its_leaves(lattice, policy, level, mask % 8,
                                          static_cast<std::uint8_t>(mask),
                                          0x1p-51 * lattice.edge(lattice.depth));
      }
    }
  }
  EXPECT_EQ(leaves, 2u * 128 * 8 * (1 + 8 + 64 + 5 * 8));
}

TEST(NestedBall, IsThePublishedOneWhereNoLeafSticksOut) {
  const Lattice lattice = lattice_of(6, 0.25);
  for (unsigned mask = 1; mask < 256; ++mask) {
    for (int level = 0; level <= 6; ++level) {
      const auto bits = static_cast<std::uint8_t>(mask);
      const Eigen::Vector3d at = cube_centre(lattice, level, 0);
      const Ball published = implicit_ball(SpherePolicy::kTable, lattice, level, at, bits),
                 nested = nested_ball(SpherePolicy::kTable, lattice, level, at, bits);
      const int squared = kLookupTable[mask].radius_squared;
      const bool larger = level > 0 && squared != 27 && squared != 108;
      EXPECT_EQ(nested.centre, published.centre);
      EXPECT_EQ(nested.radius > published.radius, larger) << level << ' ' << mask;
      EXPECT_LE(nested.radius, published.radius + 0.1413 * 0.25) << level << ' ' << mask;
    }
  }
}

TEST(SpherePolicy, HasNamesThatComeBack) {
  for (const SpherePolicy policy : kSpherePolicies) {
    EXPECT_EQ(sphere_policy(to_string(policy)), policy);
    EXPECT_EQ(is_implicit(policy),
              policy == SpherePolicy::kSimple || policy == SpherePolicy::kTable);
  }
  EXPECT_EQ(sphere_policy("Tight"), std::nullopt);
  EXPECT_EQ(sphere_policy(""), std::nullopt);
}

}  // namespace
}  // namespace ist
