#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "hardware/exact_pair.h"
#include "hardware/pair_walk.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/lookup_table.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/rigid_pose.h"

namespace ist::test {
namespace {

// Just touching, and just not: a pose is rounded to 2⁻⁵³ of its lengths, and these are up to 2¹⁸
// reaches, so this is as close as it can be.
constexpr double kTouching = 1 - 0x1p-33, kApart = 1 + 0x1p-33;

struct Counts {
  std::size_t asked = 0, touching = 0, missed = 0, hits = 0;
};

// Two nodes at a pose, decided by the circuit and by rational numbers.
void decide(const Lattice& fixed_lattice, const Lattice& moving_lattice,
            const Eigen::Isometry3d& pose, const HardwareNode& fixed, const HardwareNode& moving,
            Counts& counts) {
  const QuantizedPose quantized = quantize_pose(pose, fixed_lattice, moving_lattice);
  const PairAnswer answer = test_pair(node_pair(quantized, fixed, moving), quantized.registers);
  const bool touch = ExactFrames(pose, fixed_lattice, moving_lattice).touch(fixed, moving);
  ++counts.asked;
  counts.touching += touch ? 1 : 0;
  counts.hits += answer.hit ? 1 : 0;
  if (!touch || answer.hit) return;
  if (counts.missed++ == 0) {
    ADD_FAILURE() << "a miss where the balls touch: levels " << fixed.level << ' ' << moving.level
                  << ", masks " << int{fixed.mask} << ' ' << int{moving.mask} << ", pose\n"
                  << pose.matrix();
  }
}

void ask_at_tangency(const Lattice& fixed_lattice, const Lattice& moving_lattice,
                     const Eigen::Matrix3d& rotation, const HardwareNode& fixed,
                     const HardwareNode& moving, const Eigen::Vector3d& direction, Counts& counts) {
  for (const double part : {kTouching, kApart}) {
    decide(fixed_lattice, moving_lattice,
           pose_at(rotation, fixed_lattice, moving_lattice, fixed, moving, direction, part), fixed,
           moving, counts);
  }
}

void expect_both(const Counts& counts) {
  EXPECT_EQ(counts.missed, 0u) << "of " << counts.touching;
  EXPECT_EQ(counts.touching * 2, counts.asked) << "not at tangency";
}

TEST(NoMiss, AtRandomTangencies) {
  Random random(1);
  Counts counts;
  for (int i = 0; i < samples(8000); ++i) {
    const int fixed_depth = static_cast<int>(random.below(17));
    const int moving_depth = static_cast<int>(random.below(17));
    // The sizes differ by a factor of up to 7.9, either way, which is no power of two. At depth 16
    // it is at most 4, or a moved centre would not fit.
    const int largest = moving_depth == 16 ? 5 : 6;
    const double ratio =
        std::ldexp(random.uniform(1, 1.97),
                   static_cast<int>(random.below(static_cast<std::size_t>(largest))) - 3);
    const Lattice fixed_lattice = centred_lattice(fixed_depth, random.uniform(0.1, 20));
    const Lattice moving_lattice = centred_lattice(moving_depth, ratio * fixed_lattice.voxel_size);
    const auto level = [&](int depth) {
      return static_cast<int>(random.below(static_cast<std::size_t>(depth) + 1));
    };
    ask_at_tangency(fixed_lattice, moving_lattice, random.rotation(),
                    random_node(random, fixed_depth, level(fixed_depth)),
                    random_node(random, moving_depth, level(moving_depth)), random.direction(),
                    counts);
  }
  expect_both(counts);
}

TEST(NoMiss, OfAnyMasks) {
  Random random(2);
  const Lattice lattice = centred_lattice(6);
  Counts counts;
  for (int mask = 1; mask < 256; ++mask) {
    for (const int i : {0, 1, 2, 3, 4, 5, 6, 7}) {
      HardwareNode fixed = random_node(random, 6, i % 4), moving = random_node(random, 6, i / 2);
      (i % 2 == 0 ? fixed : moving).mask = static_cast<std::uint8_t>(mask);
      ask_at_tangency(lattice, lattice, random.rotation(), fixed, moving, random.direction(),
                      counts);
    }
  }
  expect_both(counts);
}

// The ends of levels and sizes, along axes and diagonals, for turns that fixed point has exactly
// and for those that it has least well.
TEST(NoMiss, AtTheEndsOfAllFormats) {
  Random random(3);
  std::vector<Eigen::Matrix3d> rotations = quarter_turns();
  rotations.resize(6);
  rotations.push_back(Eigen::AngleAxisd(1e-5, Eigen::Vector3d(1, 2, 3).normalized()).matrix());
  rotations.push_back(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()).matrix());
  rotations.push_back(Eigen::AngleAxisd(M_PI / 3, Eigen::Vector3d(1, 1, 1).normalized()).matrix());
  Counts counts;
  for (const double ratio : {0x1p-20, 0.01, 1.0, std::sqrt(2.0), 7.999}) {
    for (const int fixed_level : {0, 16}) {
      for (const int moving_level : {0, ratio > 4 ? 15 : 16}) {
        for (const Eigen::Matrix3d& rotation : rotations) {
          const int moving_depth = ratio > 4 ? 15 : 16;
          const Lattice fixed = centred_lattice(16);
          const Lattice moving = centred_lattice(moving_depth, 12 * ratio);
          for (const Eigen::Vector3d& way :
               {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, -1, 1)}) {
            HardwareNode a = random_node(random, 16, fixed_level);
            HardwareNode b = random_node(random, moving_depth, moving_level);
            ask_at_tangency(fixed, moving, rotation, a, b, way.normalized(), counts);
            a.mask = b.mask = 255;
            ask_at_tangency(fixed, moving, rotation, a, b, way.normalized(), counts);
          }
        }
      }
    }
  }
  expect_both(counts);
}

// Radii of 9 and 9 ratio need no rounding. So nothing is to spare when the last bits of the reach
// and the distance are cut off.
TEST(NoMiss, WhereRadiiAreExact) {
  Random random(7);
  Counts counts;
  for (int i = 0; i < samples(4000); ++i) {
    // The largest error of the offset, 0.0101 of a last bit, is added before rounding up.
    const double radius = static_cast<double>(9216 + random.below(9216)) - 0.0102;
    const Lattice fixed_lattice = centred_lattice(15);
    const Lattice moving_lattice = centred_lattice(15, 12 * radius / 2304);
    HardwareNode fixed = random_node(random, 15, static_cast<int>(4 + random.below(12)));
    HardwareNode moving = random_node(random, 15, static_cast<int>(4 + random.below(12)));
    fixed.mask = moving.mask = 0x0F;
    ask_at_tangency(fixed_lattice, moving_lattice, random.rotation(), fixed, moving,
                    random.direction(), counts);
  }
  expect_both(counts);
}

// Meshes far from the origin of their files. Composing their frames loses digits of doubles.
TEST(NoMiss, FarFromTheOrigin) {
  Random random(4);
  Counts counts;
  for (int i = 0; i < samples(500); ++i) {
    Lattice fixed = centred_lattice(8, 0.3), moving = centred_lattice(8, 0.41);
    const double far = std::ldexp(1, static_cast<int>(random.below(40)));
    for (double& x : fixed.corner) x += random.uniform(-far, far);
    for (double& x : moving.corner) x += random.uniform(-far, far);
    const Eigen::Matrix3d rotation = random.rotation();
    const HardwareNode a = random_node(random, 8, 0), b = random_node(random, 8, 0);
    // Finds the last pose on a line with touching bodies, by bisection of the exact answer.
    const Eigen::Vector3d way = random.direction();
    const Eigen::Vector3d from = fixed.origin() - rotation * moving.origin();
    const double touching = last_touching(0, 1000, [&](double t) {
      return t < 1 || ExactFrames(pose_of(rotation, from + t * way), fixed, moving).touch(a, b);
    });
    decide(fixed, moving, pose_of(rotation, from + touching * way), a, b, counts);
  }
  EXPECT_EQ(counts.missed, 0u);
  EXPECT_EQ(counts.asked, samples(std::size_t{500}));
}

// The true error of the centres, in parts of the pad. The pad must hold it and be of its size: a
// quarter of the pad would not do.
TEST(NoMiss, ThePadIsNeededAndIsEnough) {
  Random random(5);
  double most = 0;
  std::size_t missed_with_a_quarter = 0;
  const int tried = samples(20'000);
  for (int i = 0; i < tried; ++i) {
    const int depth = i % 2 == 0 ? 16 : 4;
    const Lattice lattice = centred_lattice(depth);
    // Masks of four children in a plane: the radius is 9, and rounding does not add to it.
    HardwareNode fixed = random_node(random, depth, 0), moving = random_node(random, depth, 0);
    fixed.mask = 0x0F;
    if (depth == 16) {  // the rounding of M counts most at the root's corners
      for (std::int32_t& x : moving.centre)
        x = random.below(2) == 0 ? kMaxCentre - 6 : 6 - kMaxCentre;
    }
    const Eigen::Matrix3d rotation = random.rotation();
    // Rounding down moves a centre in this direction, away from the fixed one.
    const Eigen::Isometry3d pose = pose_at(rotation, lattice, lattice, fixed, moving,
                                           Eigen::Vector3d(-1, -1, -1).normalized(), kTouching);
    QuantizedPose quantized = quantize_pose(pose, lattice, lattice);
    const NodePair pair = node_pair(quantized, fixed, moving);
    const ExactPoint exact = ExactFrames(pose, lattice, lattice).between(fixed, moving);
    const std::array<std::int64_t, 3> distance = ball_distance(pair, quantized.registers);
    ExactPoint error;
    for (std::size_t k = 0; k < 3; ++k) {
      error[k] = mpq_class(static_cast<long>(distance[k])) - 256 * exact[k];
    }
    most = std::max(most, std::sqrt(square(error).get_d()) / quantized.registers.pad);
    ASSERT_TRUE(test_pair(pair, quantized.registers).hit) << i;
    quantized.registers.pad = static_cast<std::uint16_t>(quantized.registers.pad / 4);
    if (!test_pair(pair, quantized.registers).hit) ++missed_with_a_quarter;
  }
  std::printf("[   PAD    ] %.3f of it used at most; with a quarter of it %zu of %d missed\n", most,
              missed_with_a_quarter, tried);
  EXPECT_LE(most, 1);
  // The more samples, the worse is the worst of them.
  EXPECT_GT(most, effort() < 1 ? 0.6 : 0.75)
      << "the pad is larger than it need be, or the worst case is not here";
  EXPECT_GT(missed_with_a_quarter, 0u);
}

// The width of the band of false hits: the sum in README.md, by level and ratio.
TEST(NearMiss, IsAHitOnlyWithinThePublishedBand) {
  Random random(6);
  double widest_leaf = 0, widest_node = 0;
  for (int i = 0; i < samples(4000); ++i) {
    const int level = i % 2 == 0 ? 0 : 6 + static_cast<int>(random.below(3));
    const double ratio = random.uniform(1, 2) / static_cast<double>(1u << random.below(7));
    const Lattice fixed_lattice = centred_lattice(10),
                  moving_lattice = centred_lattice(10, 12 * ratio);
    const HardwareNode fixed = random_node(random, 10, level);
    const HardwareNode moving = random_node(random, 10, level);
    const Eigen::Matrix3d rotation = random.rotation();
    const Eigen::Vector3d way = random.direction();
    const auto hit = [&](double beyond) {
      const Eigen::Isometry3d pose =
          pose_at(rotation, fixed_lattice, moving_lattice, fixed, moving, way, 1 + beyond);
      const QuantizedPose quantized = quantize_pose(pose, fixed_lattice, moving_lattice);
      return test_pair(node_pair(quantized, fixed, moving), quantized.registers).hit;
    };
    const double of_steps = 2.7321 / (1 << 14) + 0.00059 + 0.00078 / (1 + ratio);
    const double of_pad = 10.0 / (level == 0 ? 2661 : 1331) / (1 + ratio) / (1 << level);
    ASSERT_FALSE(hit(of_steps + of_pad)) << "level " << level;
    double inside = 0, outside = of_steps + of_pad;
    for (int step = 0; step < 12; ++step) {
      const double middle = 0.5 * (inside + outside);
      (hit(middle) ? inside : outside) = middle;
    }
    double& widest = level == 0 ? widest_leaf : widest_node;
    widest = std::max(widest, inside);
  }
  std::printf("[   BAND   ] leaves: %.3f %% of the reach at most; levels 6 to 8: %.3f %%\n",
              100 * widest_leaf, 100 * widest_node);
  EXPECT_GT(widest_leaf, 0.0015);
  EXPECT_LT(widest_node, 0.0015);
}

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
        quantize_pose(pose, voxels_of(fixed).lattice, voxels_of(moving).lattice);
    const ExactFrames exact(pose, voxels_of(fixed).lattice, voxels_of(moving).lattice);
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
