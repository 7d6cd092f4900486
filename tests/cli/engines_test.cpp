#include <algorithm>

#include "cli/cli_case.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "simd/dispatch.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

// The engines of collide and approach, their instruction sets and their workers.
class Engines : public CliTest {
 protected:
  [[nodiscard]] std::vector<std::string> question(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"collide", tree_,    tree_,      "--poses",
                                       list_,     "--json", "--repeat", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  // The answers alone: without how they were come by, and how fast.
  static std::vector<json> answers(const CommandResult& result) {
    std::vector<json> lines = json_lines(result.out);
    for (json& line : lines) {
      for (const char* key : {"target", "workers", "microseconds_min", "microseconds_median"}) {
        line.erase(key);
      }
    }
    return lines;
  }
  void refuses(const std::vector<std::string>& arguments, const std::string& part) const {
    const CommandResult result = ist(question(arguments));
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
  }
  // Runs the command with IST_TARGET in its environment.
  static CommandResult with_target(const std::string& target, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"IST_TARGET=" + target, IST_COMMAND});
    return run_command("/usr/bin/env", arguments);
  }

  const std::string tree_ = ball_tree("ball.ist", "slab");
  const std::string list_ = poses({0, 1, 3.9, 100});
};

TEST_F(Engines, EveryTargetAnswersAlike) {
  IST_SLOW();
  for (const char* spheres : {"table", "slab"}) {
    const auto expected = answers(ist_well(question({"--spheres", spheres})));
    ASSERT_EQ(expected.size(), 4u);
    EXPECT_GT(expected[0]["leaf_pairs"], 0);
    for (const Kernels& kernels : all_kernels()) {
      const CommandResult named =
          ist_well(question({"--spheres", spheres, "--target", kernels.target}));
      EXPECT_EQ(answers(named), expected);
      for (const json& line : json_lines(named.out)) EXPECT_EQ(line["target"], kernels.target);
    }
  }
}

TEST_F(Engines, TheEnvironmentNamesATarget) {
  const auto target_of = [](const CommandResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json_lines(result.out).at(0)["target"];
  };
  EXPECT_EQ(target_of(ist(question({}))), select_kernels({}).target);
  EXPECT_EQ(target_of(with_target("scalar", question({}))), "scalar");
  EXPECT_EQ(target_of(with_target("scalar", question({"--target", all_kernels()[0].target}))),
            all_kernels()[0].target);
  for (const char* engine : {"simd", "reference"}) {  // people's questions are asked of simd
    const CommandResult refused = with_target("nonsense", question({"--engine", engine}));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(says(refused.err, "IST_TARGET=nonsense"));
    EXPECT_TRUE(says(refused.err, "scalar"));
  }
}

TEST_F(Engines, TwoWorkersAnswerLikeOne) {
  IST_SLOW();
  const auto leaf_pairs = [this] { return file_content(path("contacts.jsonl")); };
  for (const char* spheres : {"simple", "slab"}) {
    const auto ask = [&](const std::string& workers) {
      const CommandResult result = ist_well(question(
          {"--spheres", spheres, "--workers", workers, "--contacts", path("contacts.jsonl")}));
      for (const json& line : json_lines(result.out)) {
        EXPECT_EQ(std::to_string(line["workers"].get<int>()), workers);
      }
      return answers(result);
    };
    const auto serial = ask("1");
    const std::string of_one = leaf_pairs();
    EXPECT_EQ(ask("2"), serial);
    EXPECT_EQ(leaf_pairs(), of_one);
  }
}

TEST_F(Engines, TheReferenceAgreesWhereSpheresAreCubes) {
  for (const char* spheres : {"simple", "table"}) {
    const auto lines = answers(
        ist_well(question({"--spheres", spheres, "--engine", "simd", "--engine", "reference"})));
    ASSERT_EQ(lines.size(), 8u);
    for (std::size_t i = 0; i < lines.size(); i += 2) {
      EXPECT_EQ(lines[i]["touch"], lines[i + 1]["touch"]);
      EXPECT_NEAR(lines[i]["resolution"], lines[i + 1]["resolution"], 1e-3);
    }
  }
}

TEST_F(Engines, WhatContradictsItselfIsRefused) {
  refuses({"--engine", "simd", "--engine", "simd"}, "--engine: simd is named twice");
  refuses({"--engine", "reference", "--engine", "simd", "--engine", "reference"},
          "--engine: reference is named twice");
  refuses({"--engine", "reference", "--target", "scalar"}, "--target: goes with --engine simd");
  refuses({"--engine", "reference", "--workers", "2"}, "--workers: goes with --engine simd");
  refuses({"--target", "nonsense"}, "target nonsense: this processor has no such instruction set");
  refuses({"--target", "nonsense"}, "scalar");
  for (const char* workers : {"0", "3", "-1", "x"}) refuses({"--workers", workers}, "--workers");
  ist_well(question(
      {"--engine", "reference", "--engine", "simd", "--target", "scalar", "--workers", "2"}));
}

class Verify : public CliTest {
 protected:
  // A tree of the ball whose leaves have far smaller spheres than they should.
  [[nodiscard]] std::string lying_tree() const {
    BuildOptions options;
    options.voxel_size = 0.5;
    options.spheres = SpherePolicy::kTight;
    options.keep_triangles = true;
    const SphereTree tree = build_tree(icosphere(2, 2), options);
    TreeParts parts = parts_of(tree);
    for (BallBlock& block : parts.voxels->bounds.balls[0]) {
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
