#include "ist/tree/sphere_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "ist/base/error.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/exact.h"
#include "support/random.h"
#include "support/shapes.h"

namespace ist {
namespace {

TriangleMesh random_mesh(std::uint64_t seed, int triangles) {
  test::Random random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    mesh = test::joined(
        mesh, test::triangle(random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)));
  }
  return mesh;
}

SphereTree tree_of(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = SpherePolicy::kSlab;
  return build_tree(mesh, options);
}

// |centre| + radius <= reach, in rationals.
void expect_within_reach(const SphereTree& tree) {
  for (const SpherePolicy policy : kSpherePolicies) {
    for (const auto& level : save_spheres(tree, policy)) {
      for (const Ball& ball : level) {
        const mpq_class room = mpq_class(tree.bounding_radius()) - mpq_class(ball.radius);
        ASSERT_GE(room, 0);
        ASSERT_LE(test::square(test::exact(ball.centre)), room * room) << to_string(policy);
      }
    }
  }
}

TEST(SphereTree, NoSphereReachesFartherThanItsReach) {
  for (std::uint64_t seed = 1; seed <= test::samples(std::uint64_t{3}); ++seed) {
    expect_within_reach(tree_of(random_mesh(seed, 5), 0.11));
  }
  expect_within_reach(tree_of(test::icosphere(2, 1), 0.1));
  expect_within_reach(tree_of(test::icosphere(2, 1), 100));
}

// The balls of the table that stick out farthest: each mask at the root, and each at all levels.
TEST(SphereTree, NoMaskReachesFartherThanItsReach) {
  for (const double voxel_size : {1.0, 0.3, 1e-7, 12345.678}) {
    for (unsigned mask = 1; mask < 256; ++mask) {
      for (const std::uint8_t below : {std::uint8_t{0x81}, static_cast<std::uint8_t>(mask)}) {
        std::vector<std::vector<std::uint8_t>> masks(3);
        std::size_t nodes = 1;
        for (int level = 2; level >= 0; --level) {
          auto& here = masks[static_cast<std::size_t>(level)];
          here.assign(nodes, level == 2 ? static_cast<std::uint8_t>(mask) : below);
          nodes = 0;
          for (const std::uint8_t m : here) nodes += static_cast<unsigned>(std::popcount(m));
        }
        const auto tree =
            tree_from({TreeVoxels{Lattice{{0, 0, 0}, voxel_size, 8, 3}, LinearOctree(masks),
                                  std::vector<PackedNormal>(nodes)},
                       std::nullopt, Orientation::kOutward});
        for (const auto& ball : level_spheres(tree, SpherePolicy::kTable, 3)) {
          const mpq_class room = mpq_class(tree.bounding_radius()) - mpq_class(ball.radius);
          ASSERT_LE(test::square(test::exact(ball.centre)), room * room) << mask;
        }
        for (int level = 0; level <= 3; ++level) {
          const std::vector<std::uint64_t> codes = voxels_of(tree).octree.codes(level);
          for (std::uint32_t node = 0; node < codes.size(); ++node) {
            const Eigen::Vector3d at = cube_centre(voxels_of(tree).lattice, level, codes[node]);
            const Ball ball = voxels_of(tree).nested_ball(SpherePolicy::kTable, level, node, at);
            ASSERT_LE(ball.centre.norm() + ball.radius, tree.bounding_radius() * (1 + 1e-15))
                << mask << ' ' << level;
          }
        }
        for (const auto& ball : level_spheres(tree, SpherePolicy::kSimple, 0)) {
          ASSERT_LE(ball.centre.norm() + ball.radius, tree.bounding_radius() * (1 + 1e-15)) << mask;
        }
      }
    }
  }
}

// A search tests one ball of each node. It holds the balls of all leaves below the node.
TEST(SphereTree, ImplicitBallsAreNested) {
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed <= test::samples(std::uint64_t{3}); ++seed) {
    const SphereTree tree = tree_of(random_mesh(seed, 4), 0.11);
    const TreeVoxels& voxels = voxels_of(tree);
    const std::vector<std::uint64_t> leaves = voxels.octree.codes(0);
    for (const SpherePolicy policy : {SpherePolicy::kSimple, SpherePolicy::kTable}) {
      for (int level = 1; level <= tree.depth(); ++level) {
        const std::vector<std::uint64_t> codes = voxels.octree.codes(level);
        std::uint32_t node = 0;
        for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf, ++pairs) {
          node += codes[node] != leaves[leaf] >> 3 * level;
          const Ball outer = voxels.nested_ball(policy, level, node,
                                                cube_centre(voxels.lattice, level, codes[node])),
                     inner = voxels.nested_ball(policy, 0, leaf,
                                                cube_centre(voxels.lattice, 0, leaves[leaf]));
          ASSERT_LE((inner.centre - outer.centre).norm() + inner.radius,
                    outer.radius + 1e-15 * tree.bounding_radius())
              << to_string(policy) << ", level " << level << ", leaf " << leaf;
        }
      }
    }
  }
  EXPECT_GT(pairs, test::samples(std::size_t{5'000}));
}

TEST(SphereTree, ItsLargestLeafRadiusIsThat) {
  const SphereTree tree = tree_of(test::icosphere(2, 1), 0.1);
  for (const SpherePolicy policy : kSpherePolicies) {
    double largest = 0;
    for (const Ball& ball : level_spheres(tree, policy, 0))
      largest = std::max(largest, ball.radius);
    EXPECT_EQ(tree.largest_leaf_radius(policy), largest) << to_string(policy);
  }
}

TEST(SphereTree, OfOneVoxelIsOneSphereAPolicy) {
  for (const TriangleMesh& mesh :
       {test::icosphere(1, 1), test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
        test::triangle({0, 0, 0}, {1, 2, 3}, {0, 0, 0})}) {
    BuildOptions options;
    options.voxel_size = 5;
    options.spheres = SpherePolicy::kSlab;
    options.keep_triangles = true;
    const SphereTree tree = build_tree(mesh, options);
    EXPECT_EQ(tree.depth(), 0);
    EXPECT_EQ(voxels_of(tree).octree.node_count(), 1u);
    EXPECT_EQ(voxels_of(tree).lists.ids.size(), mesh.triangles.size());
    expect_within_reach(tree);
    for (const SpherePolicy policy : kSpherePolicies) {
      const SavedSpheres saved = save_spheres(tree, policy);
      ASSERT_EQ(saved.size(), 1u);
      ASSERT_EQ(saved[0].size(), 1u);
    }
    EXPECT_EQ(voxels_of(tree).ball(SpherePolicy::kTable, 0, 0, {0, 0, 0}).radius, 2.5 * kSqrt3);
    EXPECT_EQ(level_statistics(tree).size(), 1u);
  }
}

TEST(SphereTree, APowerOfTwoScalesEverythingExactly) {
  const TriangleMesh mesh = random_mesh(4, 10);
  const SphereTree tree = tree_of(mesh, 0.17);
  for (int k = -35; k <= 40; k += 25) {
    const double factor = std::ldexp(1.0, k);
    TriangleMesh scaled = mesh;
    for (Eigen::Vector3d& vertex : scaled.vertices) vertex *= factor;
    const SphereTree other = tree_of(scaled, 0.17 * factor);
    ASSERT_EQ(voxels_of(other).octree.codes(0), voxels_of(tree).octree.codes(0));
    EXPECT_EQ(other.bounding_radius(), tree.bounding_radius() * factor);
    for (const SpherePolicy policy : kSpherePolicies) {
      const SavedSpheres a = save_spheres(tree, policy), b = save_spheres(other, policy);
      for (std::size_t level = 0; level < a.size(); ++level) {
        for (std::size_t node = 0; node < a[level].size(); ++node) {
          ASSERT_EQ(b[level][node].centre, factor * a[level][node].centre);
          ASSERT_EQ(b[level][node].radius, factor * a[level][node].radius);
        }
      }
    }
  }
}

// Unpacked from the blocks as they are described; each number is right to one rounding.
TEST(SphereTree, UnpacksItsBounds) {
  const double voxel_size = 0.11;
  const SphereTree tree = tree_of(random_mesh(5, 6), voxel_size);
  const auto expect_near = [](double got, const mpq_class& exact) {
    EXPECT_LE(abs(mpq_class(got) - exact), abs(exact) * mpq_class(0x1p-53)) << got;
  };
  for (int level = 0; level <= tree.depth(); ++level) {
    const mpq_class edge = mpq_class(voxel_size) * (1 << level), unit = edge / 32768;
    for (std::uint32_t parent = 0; parent < voxels_of(tree).balls(level).size(); ++parent) {
      const OctreeNode& from = voxels_of(tree).octree.nodes(level + 1)[parent];
      for (int slot = 0; slot < voxels_of(tree).octree.child_count(level + 1, parent); ++slot) {
        const PackedBall packed = voxels_of(tree).balls(level)[parent][slot];
        const Ball ball = voxels_of(tree).saved_ball(level, parent, slot);
        const int centre[] = {packed.x, packed.y, packed.z};
        for (int i = 0; i < 3; ++i) {
          const mpq_class origin = mpq_class(double{from.centre[i]}) * mpq_class(voxel_size);
          expect_near(ball.centre[i], origin + centre[i] * unit);
        }
        expect_near(ball.radius, packed.r * unit);
        const PackedSlab thin = voxels_of(tree).slabs(level)[parent][slot];
        const Slab slab = voxels_of(tree).saved_slab(level, parent, slot);
        EXPECT_EQ(128 * slab.normal, Eigen::Vector3d(thin.nx, thin.ny, thin.nz));
        expect_near(slab.offset, thin.offset * edge / 256);
        expect_near(slab.half, thin.half * edge / 256);
      }
    }
  }
}

TEST(SphereTree, SpheresThatItLacksAreNamedWithTheRemedy) {
  const auto of = [](SpherePolicy policy) {
    BuildOptions options;
    options.voxel_size = 0.3;
    options.spheres = policy;
    return build_tree(test::icosphere(1, 1), options);
  };
  const auto expect_has_up_to = [](const SphereTree& tree, SpherePolicy last) {
    EXPECT_EQ(tree.tightest(), last);
    for (const SpherePolicy policy : kSpherePolicies) {
      EXPECT_EQ(tree.has(policy), policy <= last) << to_string(policy);
      const auto error = test::error_of([&] { tree.require(policy, "upper"); });
      ASSERT_EQ(error.has_value(), policy > last) << to_string(policy);
      if (!error) continue;
      EXPECT_EQ(error->code(), ErrorCode::kPolicyMissing);
      const std::string remedy = "with spheres " + std::string(to_string(policy));
      EXPECT_NE(std::string(error->what()).find("upper"), std::string::npos);
      EXPECT_NE(std::string(error->what()).find(remedy), std::string::npos);
    }
  };
  expect_has_up_to(of(SpherePolicy::kSimple), SpherePolicy::kTable);
  expect_has_up_to(of(SpherePolicy::kTable), SpherePolicy::kTable);
  expect_has_up_to(of(SpherePolicy::kTight), SpherePolicy::kTight);
  expect_has_up_to(of(SpherePolicy::kSlab), SpherePolicy::kSlab);
}

TEST(SphereTree, WithoutVoxelsSaysSo) {
  const SphereTree tree = build_tree(test::box({1, 2, 3}, {3, 8, 4}));
  EXPECT_FALSE(tree.has_voxels());
  EXPECT_EQ(tree.voxel_size(), 0);
  EXPECT_EQ(tree.leaf_count(), 0u);
  EXPECT_EQ(tree.depth(), 0);
  EXPECT_TRUE(tree.leaf_centres().empty());
  EXPECT_TRUE(level_statistics(tree).empty());
  EXPECT_FALSE(tree.has_proximity());
  EXPECT_EQ(tree.tightest(), SpherePolicy::kSimple);
  EXPECT_EQ(tree.orientation(), Orientation::kOutward);
  EXPECT_EQ(tree.origin(), Eigen::Vector3d(2, 5, 3.5));
  ASSERT_TRUE(tree.triangles());
  EXPECT_EQ(tree.self_intersections(), 0u);
  for (const SpherePolicy policy : kSpherePolicies) {
    EXPECT_FALSE(tree.has(policy)) << to_string(policy);
    EXPECT_EQ(tree.largest_leaf_radius(policy), 0) << to_string(policy);
    const auto error = test::error_of([&] { tree.require(policy, "upper"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kPolicyMissing);
    EXPECT_NE(std::string(error->what()).find("upper: the tree holds no voxels"),
              std::string::npos);
    EXPECT_NE(std::string(error->what()).find("build it with a voxel size"), std::string::npos);
  }
  EXPECT_TRUE(tree_of(test::box({1, 2, 3}, {3, 8, 4}), 0.5).has_voxels());
}

// |vertex - origin| <= radius in rationals, and the radius is no larger than it need be.
TEST(SphereTree, WithoutVoxelsItsRadiusHoldsAllVertices) {
  for (std::uint64_t seed = 1; seed <= test::samples(std::uint64_t{20}); ++seed) {
    TriangleMesh mesh = random_mesh(seed, 6);
    const double scale = std::ldexp(1.0, static_cast<int>(seed % 60) - 30);
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex = scale * vertex + Eigen::Vector3d(0, scale * 1e6, 0);
    }
    mesh.vertices.emplace_back(1e9 * scale, 0, 0);  // which no triangle names
    const SphereTree tree = build_tree(mesh);
    const mpq_class radius = tree.bounding_radius();
    mpq_class farthest = 0;
    for (const Triangle& triangle : tree.triangles()->triangles) {
      for (const std::uint32_t vertex : triangle) {
        const test::ExactPoint from =
            test::exact(tree.triangles()->vertices[vertex]) - test::exact(tree.origin());
        farthest = std::max(farthest, test::square(from));
      }
    }
    ASSERT_LE(farthest, radius * radius) << seed;
    ASSERT_GE(farthest * mpq_class(1 + 1e-14), radius * radius) << seed;
  }
}

TEST(TreeStatistics, AddUpWhatTheLevelsHold) {
  const SphereTree tree = tree_of(test::icosphere(2, 1), 0.1);
  const auto levels = level_statistics(tree);
  ASSERT_EQ(levels.size(), static_cast<std::size_t>(tree.depth()) + 1);
  for (const LevelStatistics& level : levels) {
    EXPECT_EQ(level.nodes, voxels_of(tree).octree.node_count(level.level));
    EXPECT_EQ(level.edge, 0.1 * (1 << level.level));
    ASSERT_EQ(level.spheres.size(), kSpherePolicies.size());
    // The circumsphere of a cube of edge e: (√3/2) π e³.
    const double cube_ball = unit_ball_volume(level.edge);
    EXPECT_NEAR(level.spheres[0].volume, cube_ball * level.nodes, 1e-9 * cube_ball * level.nodes);
    EXPECT_LE(level.spheres[1].volume, level.spheres[0].volume * (1 + 1e-12));
    EXPECT_EQ(level.spheres[3].volume, level.spheres[2].volume) << "slab has the balls of tight";
  }
  EXPECT_NEAR(unit_ball_volume(2), 8 * 2.720699046351327, 1e-12);
}

TEST(LengthUnits, HaveNamesAndLengths) {
  const std::pair<LengthUnit, std::pair<const char*, double>> all[] = {
      {LengthUnit::kMillimetre, {"mm", 0.001}},
      {LengthUnit::kMetre, {"m", 1}},
      {LengthUnit::kInch, {"inch", 0.0254}},
      {LengthUnit::kMicrometre, {"µm", 1e-6}}};
  EXPECT_EQ(std::size(all), kLengthUnits.size());
  for (const auto& [unit, known] : all) {
    EXPECT_EQ(to_string(unit), known.first);
    EXPECT_EQ(length_unit(known.first), unit);
    EXPECT_EQ(metres_per_unit(unit), known.second);
  }
  EXPECT_EQ(length_unit("um"), LengthUnit::kMicrometre);
  EXPECT_EQ(to_string(LengthUnit::kUnknown), "unknown");
  EXPECT_EQ(metres_per_unit(LengthUnit::kUnknown), 0);
  EXPECT_EQ(to_string(static_cast<LengthUnit>(5)), "");
  EXPECT_EQ(metres_per_unit(static_cast<LengthUnit>(5)), 0);
  for (const char* none : {"", "unknown", "MM", "mm ", "in", "cm", "micrometre"}) {
    EXPECT_EQ(length_unit(none), std::nullopt) << none;
  }
}

TEST(MeshSources, KeepAnAllowedNameAsItIs) {
  for (const std::string& name :
       {std::string(), std::string("upper.stl"), std::string(".."), std::string("a b?.stl"),
        std::string("Zähne 歯 🦷.stl"), std::string("\xC2\xA0\xDF\xBF\xE0\xA0\x80"),
        std::string("\xED\x9F\xBF\xEE\x80\x80\xF4\x8F\xBF\xBF"), std::string(255, 'x')}) {
    EXPECT_EQ(source_name(name), name);
    EXPECT_EQ(source_flaw({name}), nullptr) << name;
  }
}

TEST(MeshSources, MarkEachByteThatIsNotAllowed) {
  const std::pair<std::string, std::string> all[] = {
      {"a/b\\c", "a?b?c"},
      {std::string("a\0b", 3), "a?b"},
      {"a\nb\x1F\x7F", "a?b??"},
      {"\xC2\x85", "??"},  // a control character of Latin-1
      {"\x80"
       "a\xFF",
       "?a?"},        // no first byte of a character
      {"\xC3", "?"},  // cut off
      {"\xE6\xAD"
       "a",
       "??a"},             // cut off by another
      {"\xC0\xAF", "??"},  // a slash, longer than it is written
      {"\xE0\x80\xAF", "???"},
      {"\xF0\x80\x80\xAF", "????"},
      {"\xED\xA0\x80", "???"},       // half of a pair of UTF-16
      {"\xF4\x90\x80\x80", "????"},  // beyond Unicode
      {"\xF8\x88\x80\x80\x80", "?????"}};
  for (const auto& [text, name] : all) {
    EXPECT_EQ(source_name(text), name);
    EXPECT_NE(source_flaw({text}), nullptr) << name;
  }
}

TEST(MeshSources, CutALongNameBetweenCharacters) {
  EXPECT_EQ(source_name(std::string(300, 'x')), std::string(255, 'x'));
  EXPECT_EQ(source_name(std::string(254, 'x') + "ä"), std::string(254, 'x'));
  EXPECT_STREQ(source_flaw({std::string(256, 'x')}), "the mesh's name is longer than 255 bytes");
}

TEST(MeshSources, ThatAreNotAllowedBuildNoTree) {
  BuildOptions options;
  options.voxel_size = 1;
  for (const MeshSource& source : {MeshSource{"jaws/upper.stl"}, MeshSource{std::string(256, 'x')},
                                   MeshSource{"", 0, static_cast<LengthUnit>(5)}}) {
    options.source = source;
    const auto error = test::error_of([&] { (void)build_tree(test::icosphere(1, 1), options); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    EXPECT_NE(std::string(error->what()).find(source_flaw(source)), std::string::npos);
    EXPECT_NE(std::string(error->what()).find("give a file's name"), std::string::npos);
  }
}

TEST(MeshSources, AreUnknownUnlessTold) {
  const SphereTree tree = build_tree(test::icosphere(1, 1), {.voxel_size = 1});
  EXPECT_EQ(tree.source(), MeshSource{});
}

}  // namespace
}  // namespace ist
