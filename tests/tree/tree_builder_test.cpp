#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cmath>
#include <cstring>
#include <string>

#include "ist/base/parallel.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/voxel/voxelizer.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist {
namespace {

BuildOptions everything(double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kSlab;
  options.keep_triangles = true;
  options.proximity = true;
  return options;
}

std::vector<std::uint32_t> words(const SphereTree& tree) {
  std::vector<std::uint32_t> words;
  for (const PackedNormal normal : voxels_of(tree).normals) words.push_back(normal.word());
  return words;
}

TEST(BuildTree, HasTheVoxelsAsLeavesInOrder) {
  const TriangleMesh mesh = test::icosphere(2, 1);
  const VoxelSet voxels = voxelize(mesh, {0.13, true});
  const SphereTree tree = build_tree(mesh, everything(0.13));
  EXPECT_EQ(voxels_of(tree).lattice, voxels.lattice);
  EXPECT_EQ(voxels_of(tree).octree.codes(0), voxels.codes);
  EXPECT_EQ(voxels_of(tree).lists.first, voxels.triangles.first);
  EXPECT_EQ(voxels_of(tree).lists.ids, voxels.triangles.ids);
  EXPECT_EQ(parts_of(tree).triangles->mesh.triangles, mesh.triangles);
  const std::vector<std::uint64_t> near = proximity_voxels(mesh, voxels);
  EXPECT_EQ(voxels_of(tree).proximity->octree.codes(0), near);
}

TEST(BuildTree, KeepsNoMoreThanItIsAskedFor) {
  BuildOptions options;
  options.voxel_size = 0.2;
  EXPECT_TRUE(build_tree(test::icosphere(1, 1), options).triangles());
  options.spheres = SpherePolicy::kSimple;
  options.keep_triangles = false;
  const SphereTree tree = build_tree(test::icosphere(1, 1), options);
  EXPECT_FALSE(tree.has(SpherePolicy::kTight));
  EXPECT_FALSE(tree.triangles());
  EXPECT_FALSE(voxels_of(tree).proximity);
}

TEST(BuildTree, SavesWhatItIsAskedFor) {
  BuildOptions options;
  options.voxel_size = 0.2;
  EXPECT_EQ(build_tree(test::icosphere(1, 1), options).tightest(), SpherePolicy::kSlab);
  options.spheres = SpherePolicy::kTight;
  EXPECT_EQ(build_tree(test::icosphere(1, 1), options).tightest(), SpherePolicy::kTight);
}

TEST(BuildTree, TurnsAnInsideOutMeshOutwardAndReportsIt) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  BuildReport report, turned;
  const SphereTree right = build_tree(mesh, everything(0.15), &report);
  const SphereTree wrong = build_tree(test::inside_out(mesh), everything(0.15), &turned);
  EXPECT_EQ(report.turned_components, 0u);
  EXPECT_EQ(turned.turned_components, 1u);
  EXPECT_FALSE(turned.stages.empty());
  EXPECT_EQ(wrong.orientation(), Orientation::kOutward);
  ASSERT_EQ(voxels_of(wrong).octree.codes(0), voxels_of(right).octree.codes(0));
  const auto codes = voxels_of(wrong).octree.codes(0);
  for (std::size_t leaf = 0; leaf < codes.size(); ++leaf) {
    // The sphere's centre is the grid's, half an extent from its corner.
    const Eigen::Vector3d outward =
        0.15 * (cube_centre(voxels_of(wrong).lattice, 0, codes[leaf]).array() +
                voxels_of(wrong).lattice.root_centre()) +
        Eigen::Vector3d(voxels_of(wrong).lattice.corner.data()).array();
    EXPECT_GT(voxels_of(wrong).normals[leaf].direction().dot(outward.normalized()), 0.95);
  }
  EXPECT_EQ(voxels_of(wrong).proximity->octree.codes(0),
            voxels_of(right).proximity->octree.codes(0));
}

TEST(BuildTree, AnOpenMeshIsBelieved) {
  BuildReport report;
  const SphereTree tree = build_tree(test::open_strip(4), everything(0.5), &report);
  EXPECT_EQ(tree.orientation(), Orientation::kAssumed);
  EXPECT_EQ(report.turned_components, 0u);
  for (const PackedNormal normal : voxels_of(tree).normals) {
    EXPECT_EQ(normal.direction(), Eigen::Vector3d(0, 0, 1));
  }
}

TEST(BuildTree, AMeshWithoutAreaHasNoOutsideAndNoProximityVoxels) {
  const TriangleMesh needle = test::triangle({0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5});
  const SphereTree tree = build_tree(needle, everything(0.2));
  EXPECT_GT(tree.leaf_count(), 0u);
  EXPECT_FALSE(voxels_of(tree).proximity);
}

TEST(BuildTree, IsTheSameForAnyNumberOfThreadsAndAnyArithmeticOfTheHost) {
  const TriangleMesh mesh = test::icosphere(3, 1);
  const SphereTree reference = build_tree(mesh, everything(0.04));
  const auto expect_same = [&](const SphereTree& tree) {
    EXPECT_EQ(voxels_of(tree).octree.codes(0), voxels_of(reference).octree.codes(0));
    EXPECT_EQ(words(tree), words(reference));
    for (int level = 0; level <= tree.depth(); ++level) {
      ASSERT_EQ(voxels_of(tree).balls(level).size(), voxels_of(reference).balls(level).size());
      EXPECT_EQ(
          std::memcmp(voxels_of(tree).balls(level).data(), voxels_of(reference).balls(level).data(),
                      voxels_of(tree).balls(level).size_bytes()),
          0);
      EXPECT_EQ(
          std::memcmp(voxels_of(tree).slabs(level).data(), voxels_of(reference).slabs(level).data(),
                      voxels_of(tree).slabs(level).size_bytes()),
          0);
    }
    EXPECT_EQ(voxels_of(tree).proximity->octree.codes(0),
              voxels_of(reference).proximity->octree.codes(0));
  };
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const ScopedThreadLimit limit(threads);
    expect_same(build_tree(mesh, everything(0.04)));
  }
  constexpr unsigned kRoundUpAndFlush = 0x1F80 | 0x4000 | 0x8000 | 0x40;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(kRoundUpAndFlush);
  const SphereTree tree = build_tree(mesh, everything(0.04));
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after & 0xFFC0, kRoundUpAndFlush & 0xFFC0);
  expect_same(tree);
}

TEST(BuildTree, TheMemoryLimitCountsWhatTheTreeTakes) {
  BuildOptions options = everything(0.005);
  options.proximity = false;
  options.max_memory = 4u << 20;
  const auto error = test::error_of([&] { (void)build_tree(test::icosphere(3, 1), options); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kMemoryLimit);
  const std::string what = error->what(), before = "use a voxel size of ";
  ASSERT_NE(what.find(before), std::string::npos) << what;
  options.voxel_size = std::stod(what.substr(what.find(before) + before.size()));
  const SphereTree tree = build_tree(test::icosphere(3, 1), options);
  EXPECT_LE(tree.bytes(), options.max_memory);
}

TEST(BuildTree, WithoutAVoxelSizeMakesTrianglesAlone) {
  TriangleMesh mesh = test::inside_out(test::icosphere(2, 1));
  BuildReport report;
  const SphereTree alone = build_tree(mesh, {}, &report),
                   voxels = build_tree(mesh, everything(0.2));
  EXPECT_EQ(alone.triangles()->vertices, voxels.triangles()->vertices);
  EXPECT_EQ(alone.triangles()->triangles, voxels.triangles()->triangles);
  EXPECT_EQ(alone.orientation(), voxels.orientation());
  EXPECT_EQ(report.turned_components, 1u);
  ASSERT_EQ(report.stages.size(), 2u);
  EXPECT_STREQ(report.stages[0].name, "orientation");
  EXPECT_STREQ(report.stages[1].name, "triangle clusters");
  EXPECT_LT(alone.bytes(), voxels.bytes());
  EXPECT_TRUE(can_build_tree(mesh, {}));
}

TEST(BuildTree, WhatBelongsToVoxelsNeedsAVoxelSize) {
  const TriangleMesh mesh = test::icosphere(1, 1);
  const auto refusal = [&](const BuildOptions& options) {
    EXPECT_FALSE(can_build_tree(mesh, options));
    const auto error = test::error_of([&] { static_cast<void>(build_tree(mesh, options)); });
    return error ? to_string(error->code()) + std::string(": ") + error->what() : "none";
  };
  const std::string remedy = "give a voxel size";
  for (const BuildOptions& options :
       {BuildOptions{.keep_triangles = false}, BuildOptions{.proximity = true}}) {
    const std::string text = refusal(options);
    EXPECT_TRUE(text.starts_with("argument-invalid")) << text;
    EXPECT_NE(text.find(remedy), std::string::npos) << text;
  }
  for (const double size : {-1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(refusal({.voxel_size = size}).starts_with("voxel-size-invalid")) << size;
  }
  EXPECT_TRUE(refusal({.max_memory = 1000}).starts_with("memory-limit"));
  const Eigen::Vector3d at(1, 2, 3);
  const TriangleMesh point = test::triangle(at, at, at);
  EXPECT_FALSE(can_build_tree(point, {}));
  EXPECT_EQ(test::error_name([&] { static_cast<void>(build_tree(point)); }), "mesh-extent");
}

TEST(BuildTree, ShowsItsProgress) {
  Progress progress;
  (void)build_tree(test::icosphere(2, 1), everything(0.1), nullptr, &progress);
  EXPECT_STRNE(progress.stage(), "");
}

}  // namespace
}  // namespace ist
