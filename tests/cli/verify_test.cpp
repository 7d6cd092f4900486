#include <algorithm>

#include "cli/cli_case.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class Verify : public CliTest {
 protected:
  // A tree of the ball whose leaves have far smaller spheres than they should.
  [[nodiscard]] std::string lying_tree() const {
    BuildOptions options;
    options.voxel_size = 0.5;
    options.spheres = SpherePolicy::kTight;
    options.keep_triangles = true;
    const SphereTree tree = build_tree(icosphere(2, 2), options);
    TreeParts parts{parts_of(tree).lattice,
                    parts_of(tree).octree,
                    tree.orientation(),
                    parts_of(tree).normals,
                    parts_of(tree).bounds,
                    parts_of(tree).triangles,
                    std::nullopt};
    for (BallBlock& block : parts.bounds.balls[0]) {
      for (std::uint16_t& radius : block.r) radius = static_cast<std::uint16_t>(radius / 16);
    }
    write_tree(tree_from(std::move(parts)), path("lies.ist"));
    return path("lies.ist");
  }
};

TEST_F(Verify, WhatIsTrueIsConfirmed) {
  const std::string mesh = ball(), list = poses({0, 0.3, 3.9, 100});
  for (const std::string spheres : {"simple", "table", "tight", "slab"}) {
    for (const char* workers : {"1", "2"}) {
      const CommandResult result =
          ist_well({"collide", mesh, mesh, "--voxel-size", "0.5", "--poses", list, "--verify",
                    "--json", "--spheres", spheres, "--engine", "reference", "--engine", "simd",
                    "--workers", workers});
      EXPECT_EQ(json_lines(result.out).size(), 8u);
      EXPECT_TRUE(says(result.err,
                       "verified, reference: at each of 4 poses, the bounds of every "
                       "leaf pair overlap"));
      EXPECT_TRUE(says(result.err,
                       "verified, simd: at each of 4 poses, the bounds of every leaf "
                       "pair overlap"));
      EXPECT_TRUE(says(result.err, spheres == "simple"  ? "bounds overlap is missing"
                                   : spheres == "table" ? "cubes intersect is missing"
                                                        : "triangles cross is missing"));
    }
  }
}

TEST_F(Verify, BoundsOfTheTableDecideWithoutTheReference) {
  const std::string mesh = ball(), list = poses({0, 1});
  EXPECT_TRUE(says(ist_well({"collide", mesh, mesh, "--voxel-size", "0.5", "--poses", list,
                             "--verify", "--spheres", "table"})
                       .err,
                   "bounds overlap is missing"));
}

TEST_F(Verify, TrianglesAreCheckedWhereTheTreesHoldThem) {
  const std::string list = poses({0, 1}), bare = ball_tree("b.ist", "tight", {"--no-triangles"});
  EXPECT_TRUE(says(ist_well({"collide", bare, bare, "--poses", list, "--verify"}).err,
                   "bounds overlap is missing"));
  const std::string tree = ball_tree();
  EXPECT_TRUE(says(ist_well({"collide", tree, tree, "--poses", list, "--verify"}).err,
                   "triangles cross is missing"));
}

TEST_F(Verify, ABrokenGuaranteeHasAnExitCode) {
  const std::string lies = lying_tree();
  const std::vector<std::string> arguments{"approach", lies,   lies,  "--axis", "x",    "--from",
                                           "10",       "--to", "1.1", "--step", "4.45", "--json"};
  ist_well(arguments);
  std::vector<std::string> checked = arguments;
  checked.insert(checked.end(), {"--verify", "--contacts", path("contacts.jsonl")});
  const CommandResult result = ist(checked);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(says(result.err, "ist: pose 2, engine simd: the pair of fixed leaf "));
  EXPECT_TRUE(says(result.err, "is not in the answer, but its triangles cross"));
  EXPECT_FALSE(exists("contacts.jsonl"));
}

}  // namespace
}  // namespace ist::test
