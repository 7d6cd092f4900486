#include "ist/voxel/voxelizer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "ist/base/parallel.h"
#include "ist/voxel/triangle_bins.h"
#include "support/errors.h"
#include "support/random.h"
#include "support/shapes.h"
#include "voxel/angles.h"

namespace ist {
namespace {

using Eigen::Vector3d;
using test::angle_in_degrees;

std::vector<std::uint32_t> words(const VoxelSet& set) {
  std::vector<std::uint32_t> words;
  for (const PackedNormal normal : set.normals) words.push_back(normal.word());
  return words;
}

Vector3d centre(const Lattice& lattice, std::uint64_t code) {
  const Cell cell = morton_decode(code);
  return Vector3d(lattice.corner.data()) +
         lattice.voxel_size * Vector3d(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
}

TEST(Voxelizer, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh =
      test::joined(test::icosphere(4, 1), test::triangle({-1, -1, -1}, {1, 1, -0.9}, {-1, 1, 1}));
  VoxelSet reference;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const ScopedThreadLimit limit(threads);
    const VoxelSet set = voxelize(mesh, {0.02, true});
    if (threads == 1) {
      reference = set;
      EXPECT_GT(set.codes.size(), 20'000u);
      continue;
    }
    EXPECT_EQ(set.lattice, reference.lattice);
    EXPECT_EQ(set.codes, reference.codes);
    EXPECT_EQ(words(set), words(reference));
    EXPECT_EQ(set.triangles.first, reference.triangles.first);
    EXPECT_EQ(set.triangles.ids, reference.triangles.ids);
  }
}

TEST(Voxelizer, ListsTrianglesOnlyWhenAsked) {
  const TriangleMesh mesh = test::icosphere(2, 1);
  const VoxelSet with = voxelize(mesh, {0.1, true}), without = voxelize(mesh, {0.1, false});
  EXPECT_TRUE(without.triangles.empty());
  EXPECT_EQ(without.codes, with.codes);
  EXPECT_EQ(words(without), words(with));
}

TEST(Voxelizer, VerticesThatNoTriangleUsesDoNotCount) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  const VoxelSet set = voxelize(mesh, {0.25, false});
  mesh.vertices.emplace_back(1e6, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(voxelize(mesh, {0.25, false}).codes, set.codes);
}

TEST(Voxelizer, AMeshWithoutTrianglesHasNoExtent) {
  EXPECT_EQ(test::error_name([] {
              (void)voxelize({{{0, 0, 0}, {1, 1, 1}}, {}}, {0.1, false});
            }),
            "mesh-extent");
}

TEST(VoxelNormals, OfASpherePointOutward) {
  const VoxelSet set = voxelize(test::icosphere(4, 1), {0.1, false});
  for (std::size_t i = 0; i < set.codes.size(); ++i) {
    // Half a voxel's diagonal seen from the sphere's centre is five degrees.
    EXPECT_LE(angle_in_degrees(set.normals[i].direction(), centre(set.lattice, set.codes[i])), 6.0);
    EXPECT_GE(set.normals[i].coherence(), 0.97);
  }
}

TEST(VoxelNormals, OfAFlatPlateAreWhollyCoherent) {
  for (const PackedNormal normal : voxelize(test::open_strip(5), {0.3, false}).normals) {
    EXPECT_EQ(normal.coherence(), 1.0);
    EXPECT_EQ(normal.direction(), Vector3d(0, 0, 1));
  }
}

TEST(VoxelNormals, OfAThinPlateCancelAndAreNeverNaN) {
  const TriangleMesh strip = test::open_strip(5);
  for (const double apart : {0.0, 0.01}) {
    const TriangleMesh plate =
        test::joined(strip, test::inside_out(test::moved(strip, {0, 0, -apart})));
    for (const PackedNormal normal : voxelize(plate, {0.3, false}).normals) {
      EXPECT_EQ(normal.word(), 0u);
      EXPECT_EQ(normal.direction(), Vector3d(0, 0, 0));
    }
  }
}

TEST(VoxelNormals, OfTrianglesWithoutAreaAreZero) {
  const TriangleMesh needles = test::joined(test::triangle({0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}),
                                            test::triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}));
  const VoxelSet set = voxelize(needles, {0.2, false});
  EXPECT_FALSE(set.normals.empty());
  for (const PackedNormal normal : set.normals) EXPECT_EQ(normal.word(), 0u);
}

TEST(VoxelNormals, AreWeightedByTheAreaInsideTheVoxel) {
  // In one voxel: 3/4 of a unit square that looks up, 1/4 of one that looks along x.
  TriangleMesh mesh = test::triangle({0, 0, 0}, {0.75, 0, 0}, {0.75, 1, 0});
  mesh = test::joined(mesh, test::triangle({0, 0, 0}, {0.75, 1, 0}, {0, 1, 0}));
  mesh = test::joined(mesh, test::triangle({0.75, 0, 0}, {0.75, 1, 0}, {0.75, 1, 0.25}));
  mesh = test::joined(mesh, test::triangle({0.75, 0, 0}, {0.75, 1, 0.25}, {0.75, 0, 0.25}));
  const VoxelSet set = voxelize(mesh, {2, false});
  ASSERT_EQ(set.normals.size(), 1u);
  const Vector3d sum(0.25, 0, 0.75);
  EXPECT_LE(angle_in_degrees(set.normals[0].direction(), sum), 0.07);
  EXPECT_NEAR(set.normals[0].coherence(), sum.norm(), 1.0 / 255);
}

// Coordinates are multiples of powers of two, so that mirroring them loses nothing.
TEST(VoxelNormals, OfAMirroredMeshAreMirrored) {
  test::Random random(1);
  TriangleMesh mesh = test::box({0, 0, 0}, {8, 8, 8});
  for (int i = 0; i < 200; ++i) {
    const Vector3d a = random.point_on_grid(1, 6, 0.125);
    mesh = test::joined(mesh, test::triangle(a, a + random.point_on_grid(0, 2, 0.125),
                                             a + random.point_on_grid(0, 2, 0.125)));
  }
  TriangleMesh mirrored = test::inside_out(mesh);
  for (Vector3d& vertex : mirrored.vertices) vertex[0] = -vertex[0];
  const VoxelSet set = voxelize(mesh, {1, false}), other = voxelize(mirrored, {1, false});
  ASSERT_EQ(set.codes.size(), other.codes.size());
  for (std::size_t i = 0; i < set.codes.size(); ++i) {
    Cell cell = morton_decode(set.codes[i]);
    cell[0] = set.lattice.cells - 1 - cell[0];
    const auto found =
        std::lower_bound(other.codes.begin(), other.codes.end(), morton_encode(cell));
    ASSERT_TRUE(found != other.codes.end() && *found == morton_encode(cell));
    const PackedNormal twin = other.normals[static_cast<std::size_t>(found - other.codes.begin())];
    Vector3d direction = twin.direction();
    direction[0] = -direction[0];
    // Clipping from the other end may round a sum to the next step.
    EXPECT_LE((direction - set.normals[i].direction()).cwiseAbs().maxCoeff(), 1.5 / 2047);
    EXPECT_NEAR(twin.coherence(), set.normals[i].coherence(), 1.01 / 255);
  }
}

TEST(VoxelizerMemory, ARefusalNamesASizeThatFitsTheSameLimit) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  for (const std::uint64_t limit : {100'000u, 1'000'000u, 3'000'000u}) {
    const VoxelizerOptions options{0.002, true, limit, 26};
    const auto error = test::error_of([&] { (void)voxelize(mesh, options); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
    const std::string what = error->what(), before = "use a voxel size of ";
    ASSERT_NE(what.find(before), std::string::npos) << what;
    VoxelizerOptions advised = options;
    advised.voxel_size = std::stod(what.substr(what.find(before) + before.size()));
    const VoxelSet set = voxelize(mesh, advised);
    // Not a size much larger than need be: what it takes is near what is allowed.
    EXPECT_GE(100 * (set.codes.size() * 46 + set.triangles.ids.size() * 6), limit);
    EXPECT_LE(set.codes.size() * 42 + set.triangles.ids.size() * 6, limit);
  }
}

// A certain least number of pairs refuses the absurd size: no block is searched for it, and the
// size that is named comes from a few blocks of each size that is tried.
TEST(VoxelizerMemory, AnAbsurdSizeIsRefusedBeforeTheWork) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  for (const bool keep : {true, false}) {
    for (const double size : {1e-4, 4e-5}) {
      Progress progress;
      std::uint64_t steps = 0;
      progress.watch([&] { ++steps; });
      const VoxelizerOptions options{size, keep, 64u << 20, 26};
      const auto error = test::error_of([&] { (void)voxelize(mesh, options, &progress); });
      ASSERT_TRUE(error);
      EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
      EXPECT_EQ(steps, 0U) << "no stage began";
      const std::string what = error->what(), before = "use a voxel size of ";
      ASSERT_NE(what.find(before), std::string::npos) << what;
      VoxelizerOptions advised = options;
      advised.voxel_size = std::stod(what.substr(what.find(before) + before.size()));
      EXPECT_TRUE(can_voxelize(mesh, advised)) << what;
      advised.voxel_size *= 0.85;
      EXPECT_FALSE(can_voxelize(mesh, advised)) << "not much larger than it must be";
    }
  }
}

// A size that is a little too small is known when the voxels so far need too much.
TEST(VoxelizerMemory, TheSearchForVoxelsEndsWhereTheyNeedTooMuch) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  const ScopedThreadLimit one(1);
  const VoxelizerOptions options{0.002, true, 16u << 20, 100};
  Progress progress;
  double most = 0;
  progress.watch([&] { most = std::max(most, progress.fraction()); });
  EXPECT_FALSE(can_voxelize(mesh, options, &progress));
  EXPECT_LT(most, 0.2);
  VoxelizerOptions more = options;
  more.max_memory = 1u << 30;
  EXPECT_TRUE(can_voxelize(mesh, more));
}

TEST(PairCounts, HoldTheTrueNumberOfPairs) {
  test::Random random(9);
  for (int i = 0; i < 40; ++i) {
    TriangleMesh mesh =
        test::triangle(random.point_on_grid(0, 9, 0.01), random.point_on_grid(0, 9, 0.01),
                       random.point_on_grid(0, 9, 0.01));
    const double flat = random.uniform(0, 1) < 0.3 ? 0 : 1;
    for (Vector3d& v : mesh.vertices) v[i % 3] *= flat;
    mesh = test::joined(mesh, mesh);
    const PairCounts counts(mesh);
    for (const double size : {0.05, 0.3, 2.0}) {
      const VoxelSet set = voxelize(mesh, {size, true});
      const auto pairs = static_cast<double>(set.triangles.ids.size());
      EXPECT_LE(counts.least(size), pairs);
      EXPECT_GE(counts.least(size), 0.4 * counts.expected(size) - 60 - 60 / size);
    }
  }
}

TEST(VoxelizerMemory, NothingIsRefusedThatFits) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  EXPECT_EQ(test::error_name([&] { (void)voxelize(mesh, {0.05, true, 64u << 20, 24}); }), "none");
}

TEST(VoxelizerMemory, WhereNoSizeFitsTheRefusalSaysSo) {
  const auto error = test::error_of([&] {
    (void)voxelize(test::icosphere(3, 1), {0.05, true, 1000});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
  EXPECT_EQ(std::string(error->what()).find("or larger"), std::string::npos) << error->what();
}

}  // namespace
}  // namespace ist
