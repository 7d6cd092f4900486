#include <gtest/gtest.h>

#include <cstdio>

#include "hardware/exact_pair.h"
#include "hardware/pair_walk.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/closing.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/skip.h"

namespace ist::test {
namespace {

SphereTree plain_tree(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  return build_tree(mesh, options);
}

// All pairs of nodes that a query at these poses asks the circuit, each held against rational
// numbers; and the way as a whole against the reference's.
void expect_no_miss(const SphereTree& fixed, const SphereTree& moving,
                    std::initializer_list<double> closings) {
  std::uint64_t asked = 0, touching = 0, missed = 0, false_hits = 0;
  for (const double dz : closings) {
    const Eigen::Isometry3d pose = closing(dz);
    const QuantizedPose quantized =
        quantize_pose(pose, parts_of(fixed).lattice, parts_of(moving).lattice);
    const ExactFrames exact(pose, parts_of(fixed).lattice, parts_of(moving).lattice);
    const auto touch = [&](const HardwareNode& a, const HardwareNode& b) {
      const bool hit = test_pair(node_pair(quantized, a, b), quantized.registers).hit;
      const bool intersects = exact.touch(a, b);
      ++asked;
      touching += intersects ? 1u : 0u;
      missed += intersects && !hit ? 1u : 0u;
      false_hits += hit && !intersects ? 1u : 0u;
      return hit;
    };
    const auto counts = PairWalk(fixed, moving, touch).run();
    ReferenceQuery reference(fixed, moving, SpherePolicy::kTable);
    const FoundPairs answer = ask(reference, pose);
    EXPECT_GE(counts.tested, answer.result.sphere_tests) << dz;
    EXPECT_GE(counts.leaf_pairs, answer.result.leaf_pairs) << dz;
    // 1 % is far more than near misses cost.
    EXPECT_LE(static_cast<double>(counts.tested),
              1.01 * static_cast<double>(answer.result.sphere_tests))
        << dz;
  }
  EXPECT_EQ(missed, 0u);
  EXPECT_GT(touching, asked / 100);
  const double rate = static_cast<double>(false_hits) / static_cast<double>(asked - touching);
  std::printf("[   NEAR   ] %llu pairs, of %llu that do not touch %llu called hits: %.4f %%\n",
              static_cast<unsigned long long>(asked),
              static_cast<unsigned long long>(asked - touching),
              static_cast<unsigned long long>(false_hits), 100 * rate);
  EXPECT_LT(rate, 0.005);
}

TEST(HardwarePairs, OfTheBuiltInJaws) {
  IST_SLOW();
  expect_no_miss(plain_tree(make_jaw(Jaw::kUpper, 1), 1), plain_tree(make_jaw(Jaw::kLower, 2), 1),
                 {0, -1.5, -3});
}

TEST(HardwarePairs, OfTwoVoxelSizes) {
  IST_SLOW();
  expect_no_miss(plain_tree(make_jaw(Jaw::kUpper, 1), 3), plain_tree(make_jaw(Jaw::kLower, 2), 1.3),
                 {0, -1.5});
  expect_no_miss(plain_tree(make_jaw(Jaw::kUpper, 1), 1.3), plain_tree(make_jaw(Jaw::kLower, 2), 3),
                 {0, -1.5});
}

TEST(HardwarePairs, OfTheHumanJaws) {
  IST_SLOW();
  const auto fixed = data_dir() / "human_maxilla.stl", moving = data_dir() / "human_mandible.stl";
  if (!std::filesystem::exists(fixed)) IST_SKIP(fixed << " is not there");
  expect_no_miss(plain_tree(read_mesh(fixed), 0.8), plain_tree(read_mesh(moving), 0.8),
                 {0, -1, -2});
}

}  // namespace
}  // namespace ist::test
