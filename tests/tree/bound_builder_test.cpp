// Saved bounds of leaves against their payload in exact arithmetic: the triangles of the leaf,
// clipped to its grown cube. The blocks are unpacked here, from their description.

#include "ist/tree/bound_builder.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ist/base/parallel.h"
#include "ist/models/models.h"
#include "ist/voxel/voxelizer.h"
#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using test::ExactPoint;

struct Built {
  VoxelSet voxels;
  LinearOctree octree;
  BoundBlocks bounds;
};

Built build(const TriangleMesh& mesh, double voxel_size,
            SpherePolicy policy = SpherePolicy::kSlab) {
  BoundBuilder builder(policy);
  VoxelSet voxels =
      voxelize(mesh, {.voxel_size = voxel_size, .keep_triangles = true, .visitor = &builder});
  LinearOctree octree(voxels.codes, voxels.lattice.depth);
  BoundBlocks bounds = builder.finish(octree);
  return {std::move(voxels), std::move(octree), std::move(bounds)};
}

// The payload of a leaf from its definition: the triangles that it lists, clipped.
std::vector<ExactPoint> payload(const TriangleMesh& mesh, const VoxelSet& voxels,
                                std::size_t leaf) {
  const test::ExactBox cube = test::grown(test::node_cube(voxels.lattice, 0, voxels.codes[leaf]),
                                          test::exact_pad(voxels.lattice));
  std::vector<ExactPoint> points;
  for (const std::uint32_t t : voxels.triangles[leaf]) {
    const test::ExactPolygon piece = test::clip(test::exact_triangle(mesh, t), cube);
    points.insert(points.end(), piece.begin(), piece.end());
  }
  return points;
}

// The smallest ball, and what a radius may have more: 1 %, three units, twice the pad.
void expect_ball(const PackedBall& ball, const ExactPoint& centre, const mpq_class& unit,
                 const mpq_class& pad, const std::vector<ExactPoint>& points) {
  ASSERT_GT(ball.r, 0);
  const mpq_class radius = ball.r * unit;
  for (const ExactPoint& p : points) ASSERT_LE(test::square(p - centre), radius * radius);
  const double smallest = std::sqrt(test::smallest_ball(points).radius_squared.get_d());
  const mpq_class more = 3 * unit + 2 * pad;
  ASSERT_LE(radius.get_d(), 1.01 * smallest + more.get_d());
}

// No wider than its normal asks for, but for half a unit of the offset and one of the width.
void expect_slab(const PackedSlab& slab, const ExactPoint& centre, const mpq_class& unit,
                 const std::vector<ExactPoint>& points) {
  const int nx = slab.nx, ny = slab.ny, nz = slab.nz;
  ASSERT_LE(nx * nx + ny * ny + nz * nz, 128 * 128);
  ASSERT_GE(nx * nx + ny * ny + nz * nz, 125 * 125);
  const ExactPoint normal =
      mpq_class(1, 128) * ExactPoint{{mpq_class(nx), mpq_class(ny), mpq_class(nz)}};
  const mpq_class offset = slab.offset * unit, half = slab.half * unit;
  mpq_class least = test::dot(normal, points[0] - centre), greatest = least;
  for (const ExactPoint& p : points) {
    const mpq_class height = test::dot(normal, p - centre);
    ASSERT_LE(abs(height - offset), half);
    least = std::min(least, height);
    greatest = std::max(greatest, height);
  }
  ASSERT_LT(half, (greatest - least) / 2 + mpq_class(1501, 1000) * unit);
}

void expect_bounds(const TriangleMesh& mesh, double voxel_size) {
  const Built built = build(mesh, voxel_size);
  const Lattice& lattice = built.voxels.lattice;
  const mpq_class pad = test::exact_pad(lattice);
  const std::vector<std::uint64_t>& codes = built.voxels.codes;
  const auto& balls = built.bounds.balls[0];
  const auto& slabs = built.bounds.slabs[0];
  const bool root = lattice.depth == 0;
  ASSERT_EQ(balls.size(), root ? 1 : built.octree.node_count(1));
  ASSERT_EQ(slabs.size(), balls.size());
  std::size_t parent = 0;
  int slot = -1;
  for (std::size_t leaf = 0; leaf < codes.size(); ++leaf) {
    SCOPED_TRACE("leaf " + std::to_string(leaf));
    if (leaf > 0 && codes[leaf] >> 3 != codes[leaf - 1] >> 3) {
      ++parent;
      slot = -1;
    }
    ++slot;
    const test::ExactBox cube = test::node_cube(lattice, 0, codes[leaf]);
    const test::ExactBox around = root ? cube : test::node_cube(lattice, 1, codes[leaf] >> 3);
    const ExactPoint from = mpq_class(1, 2) * (around.low + around.high);
    const mpq_class edge = cube.high[0] - cube.low[0];
    const std::vector<ExactPoint> points = payload(mesh, built.voxels, leaf);
    ASSERT_FALSE(points.empty()) << "a leaf without a surface point";

    const PackedBall ball = balls[parent][slot];
    const mpq_class unit = 2 * edge / 65536;
    const ExactPoint centre =
        from + unit * ExactPoint{{mpq_class(ball.x), mpq_class(ball.y), mpq_class(ball.z)}};
    ASSERT_NO_FATAL_FAILURE(expect_ball(ball, centre, unit, pad, points));
    ASSERT_NO_FATAL_FAILURE(expect_slab(slabs[parent][slot], centre, edge / 256, points));
  }
  ASSERT_EQ(parent + 1, balls.size());
}

TEST(Bounds, OfASphere) { expect_bounds(test::icosphere(2, 1), 0.21); }

// Where the surface lies on the far faces of cubes, and a centre beyond what its block can hold.
TEST(Bounds, OfABoxOnThePlanesOfTheGrid) {
  expect_bounds(test::box({0, 0, 0}, {5, 3, 2}), 1);
  expect_bounds(test::box({0.1, 0.2, 0.3}, {0.9, 0.6, 0.5}), 0.1);
}

TEST(Bounds, OfRandomTrianglesSliversSegmentsAndPoints) {
  test::Random random(1);
  TriangleMesh mesh;
  for (int i = 0; i < 12; ++i) {
    const Vector3d a = random.point(-1, 1), b = random.point(-1, 1), c = random.point(-1, 1);
    const Vector3d between = a + random.uniform(0, 1) * (b - a);
    const Vector3d third[] = {c, between, between + 1e-6 * c, a};
    mesh = test::joined(mesh, test::triangle(a, i % 6 == 5 ? a : b, third[i % 4]));
  }
  expect_bounds(mesh, 0.23);
}

TEST(Bounds, FarFromTheOrigin) {
  expect_bounds(test::moved(test::icosphere(1, 1), {1e6, -1e6, 1e6}), 0.21);
}

TEST(Bounds, OfOneVoxel) {
  expect_bounds(test::icosphere(1, 1), 7);
  expect_bounds(test::icosphere(1, 1), 1990);
}

// Small triangles in large nodes, and large triangles in small ones.
TEST(Bounds, OfTrianglesMuchSmallerAndMuchLargerThanVoxels) {
  const TriangleMesh small = test::moved(test::icosphere(2, 0.05), {2, 2, 2});
  expect_bounds(test::joined(small, test::triangle({0, 0, 0}, {3, 0.3, 1}, {1, 3, 2.9})), 0.4);
}

// Segments whose radius is a whole number of units, up to the rounding of lattice coordinates.
TEST(Bounds, HoldWhatRoundingHides) {
  test::Random random(2);
  for (int i = 0; i < test::samples(20); ++i) {
    const double from = random.uniform(1e-3, 1e-2), to = from + random.uniform(0.1, 1);
    expect_bounds(test::triangle({from, 0, 0}, {to, 0, 0}, {from, 0, 0}), to - from);
  }
}

// A grid of 65,536 cells, where the pad is twice the unit of a leaf's ball.
TEST(Bounds, OnTheFinestGrid) {
  const Vector3d small(0x1p-15, 0, 0x1p-17);
  expect_bounds(test::joined(test::triangle({0, 0, 0}, small, {0, 0x1p-15, 0}),
                             test::triangle({1, 1, 1}, {1, 1, 1 - 0x1p-16}, {1, 1 - 0x1p-15, 1})),
                0x1p-16);
}

TEST(Bounds, OfAFlatPatchAreSlabsAsThinAsTheirUnit) {
  const Built built = build(test::open_strip(3), 0.3);
  for (const SlabBlock& block : built.bounds.slabs[0]) {
    for (int slot = 0; slot < 8; ++slot) EXPECT_LE(block.half[slot], 2);
    EXPECT_EQ(std::abs(block.nz[0]), 126);
  }
}

// The leaves alone decide every answer: their bytes are the same everywhere.
TEST(Bounds, OfLeavesHaveTheSameBytesEverywhere) {
  const Built built = build(make_jaw(Jaw::kUpper, 1), 0.5);
  const auto hash = [](const auto& blocks) {
    return XXH3_64bits(blocks.data(), blocks.size() * sizeof(blocks[0]));
  };
  EXPECT_EQ(hash(built.bounds.balls[0]), 0x3717a3ab942eedbf);
  EXPECT_EQ(hash(built.bounds.slabs[0]), 0x3f2572648d5c2392);
}

bool is_zero(const void* bytes, std::size_t count) {
  const auto* const first = static_cast<const unsigned char*>(bytes);
  return std::all_of(first, first + count, [](unsigned char byte) { return byte == 0; });
}

TEST(Bounds, AreZeroWhereThereIsNoChild) {
  const Built built = build(test::icosphere(2, 1), 0.21);
  for (int level = 0; level <= built.octree.depth(); ++level) {
    const auto index = static_cast<std::size_t>(level);
    for (std::uint32_t p = 0; p < built.bounds.balls[index].size(); ++p) {
      for (int slot = built.octree.child_count(level + 1, p); slot < 8; ++slot) {
        const PackedBall ball = built.bounds.balls[index][p][slot];
        const PackedSlab slab = built.bounds.slabs[index][p][slot];
        EXPECT_TRUE(is_zero(&ball, sizeof(ball)) && is_zero(&slab, sizeof(slab)));
      }
    }
  }
}

template <typename Block>
void expect_same(const std::vector<std::vector<Block>>& a,
                 const std::vector<std::vector<Block>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t level = 0; level < a.size(); ++level) {
    ASSERT_EQ(a[level].size(), b[level].size());
    EXPECT_EQ(std::memcmp(a[level].data(), b[level].data(), a[level].size() * sizeof(Block)), 0);
  }
}

TEST(Bounds, WithoutSlabsHaveTheSameBalls) {
  const TriangleMesh mesh = test::icosphere(2, 1);
  const Built tight = build(mesh, 0.21, SpherePolicy::kTight), slab = build(mesh, 0.21);
  expect_same(tight.bounds.balls, slab.bounds.balls);
  EXPECT_TRUE(tight.bounds.slabs.empty());
}

TEST(Bounds, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  const auto of_threads = [&](std::size_t threads) {
    const ScopedThreadLimit limit(threads);
    return build(mesh, 0.05).bounds;
  };
  const BoundBlocks one = of_threads(1), two = of_threads(2);
  expect_same(one.balls, two.balls);
  expect_same(one.slabs, two.slabs);
}

}  // namespace
}  // namespace ist
