#include <algorithm>
#include <cmath>

#include "cli/cli_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

/// `ist advise` on two balls, of which one is 0.3 into the other along y.
class Advise : public CliTest {
 protected:
  CommandResult advise(std::vector<std::string> more) const {
    more.insert(more.begin(), {"advise", fixed_, moving_});
    return ist(more);
  }
  void refuses(const std::vector<std::string>& more, int exit_code, const std::string& part) const {
    SCOPED_TRACE(part);
    const std::size_t before = dir_.entries();
    const CommandResult result = advise(more);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(dir_.entries(), before);
  }
  // Checks keys and order of the printed lines, and returns the recommended one.
  static nlohmann::json recommended(const std::string& text) {
    nlohmann::json found;
    double last = HUGE_VAL;
    for (const nlohmann::json& line : json_lines(text)) {
      EXPECT_LT(line.at("voxel_size").get<double>(), last);
      last = line.at("voxel_size");
      EXPECT_LE(line.at("error").get<double>(), line.at("resolution").get<double>());
      EXPECT_NEAR(line.at("hertz").get<double>() * line.at("microseconds_slowest").get<double>(),
                  1e6, 1e-3);
      EXPECT_GT(line.at("build_milliseconds").get<double>(), 0);
      EXPECT_GT(line.at("memory").get<std::uint64_t>(), 0u);
      EXPECT_EQ(line.size(), 8u);
      if (!line.at("recommended").get<bool>()) continue;
      EXPECT_TRUE(found.is_null()) << text;
      found = line;
    }
    return found;
  }

  const std::string fixed_ = mesh("fixed.stl", icosphere(3, 2));
  const std::string moving_ = mesh("moving.stl", moved(icosphere(3, 2), {0.1, -3.65, 0.2}));
};

TEST_F(Advise, TheLargestVoxelsOfAnError) {
  IST_SLOW();
  const CommandResult result = advise({"--error", "0.02", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "12 poses: opening towards -y"));
  const nlohmann::json best = recommended(result.out);
  ASSERT_TRUE(best.is_object()) << result.out;
  EXPECT_LE(best.at("error").get<double>(), 0.8 * 0.02);
  for (const nlohmann::json& line : json_lines(result.out)) {
    if (line.at("error").get<double>() <= 0.8 * 0.02) {
      EXPECT_LE(line.at("voxel_size"), best.at("voxel_size"));
    }
  }
}

// A budget of seconds is kept, whatever else runs; so it is the memory that ends the search.
TEST_F(Advise, TheSmallestVoxelsOfABudget) {
  IST_SLOW();
  for (const char* workers : {"1", "2"}) {
    const CommandResult result =
        advise({"--budget-us", "1e7", "--json", "--workers", workers, "--max-memory", "2M"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(says(result.err, "note: ") && says(result.err, "more memory than --max-memory"));
    const nlohmann::json best = recommended(result.out);
    ASSERT_TRUE(best.is_object()) << result.out;
    EXPECT_LE(best.at("microseconds_slowest").get<double>(), 8e6);
    EXPECT_EQ(best, json_lines(result.out).back());
  }
}

// The table says what the lines do, and how to build what is recommended.
TEST_F(Advise, ATable) {
  IST_SLOW();
  const CommandResult result = advise({"--error", "0.1", "--axis", "-y"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json best = recommended(advise({"--error", "0.1", "--axis", "-y", "--json"}).out);
  const std::string size = best.at("voxel_size").dump();
  EXPECT_TRUE(says(result.out, "  voxel size      error  certain bound"));
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '*'), 2);
  EXPECT_TRUE(
      says(result.out, IST_COMMAND + (" build " + fixed_) + " -o fixed.ist --voxel-size " + size));
  EXPECT_TRUE(says(result.out,
                   IST_COMMAND + (" build " + moving_) + " -o moving.ist --voxel-size " + size));
  EXPECT_FALSE(exists("fixed.ist"));
}

// What is printed can be given to a shell as it is, and writes two trees.
TEST_F(Advise, BuildCommands) {
  IST_SLOW();
  std::filesystem::create_directories(path("it's left"));
  std::filesystem::create_directories(path("right"));
  std::filesystem::copy(fixed_, path("it's left/jaw.stl"));
  std::filesystem::copy(moving_, path("right/jaw.stl"));
  const CommandResult result = ist({"advise", path("it's left/jaw.stl"), path("right/jaw.stl"),
                                    "--error", "0.1", "--max-memory", "100M"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, "/it'\\''s left/jaw.stl' -o fixed.ist --voxel-size"));
  EXPECT_TRUE(says(result.out, "/right/jaw.stl -o moving.ist --voxel-size"));
  EXPECT_TRUE(says(result.out, "--max-memory 1"));
}

TEST_F(Advise, AtPoses) {
  IST_SLOW();
  const auto at = [&](const std::vector<double>& shifts) {
    return std::vector<std::string>{"--error", "0.05", "--json", "--poses", poses(shifts)};
  };
  const CommandResult result = advise(at({0, 1, 2, 3}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "4 poses from "));
  EXPECT_LE(recommended(result.out).at("error").get<double>(), 0.8 * 0.05);
  // Where nothing shows an error, none is believed to be small.
  refuses(at({0}), 3, "poses.json: no pose shows an error");
  refuses(at({100}), 3, "poses.json: no pose shows an error");
  refuses({"--budget-us", "100", "--max-memory", "2M", "--poses", poses({100})}, 3,
          "poses.json: at no pose do voxels of ");
}

// No size keeps the goal: what was measured is there, and none of it is recommended.
TEST_F(Advise, NoAdvice) {
  IST_SLOW();
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"--budget-us", "1e-3", "--json"}, "no voxel size keeps 0.0008 µs"},
      {{"--error", "1e-7", "--json", "--max-memory", "2M"},
       "no voxel size keeps an error of 8e-08, which is 80 %"}};
  for (const auto& [arguments, part] : cases) {
    const CommandResult result = advise(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(says(result.err, part));
    EXPECT_FALSE(json_lines(result.out).empty());
    EXPECT_TRUE(recommended(result.out).is_null());
  }
}

TEST_F(Advise, WhatIsNoUse) {
  refuses({}, 2, "--budget-us, --error: give one of them");
  refuses({"--budget-us", "100", "--error", "0.1"}, 2, "give one of them");
  for (const char* value : {"0", "-1", "nan", "inf"}) {
    refuses({"--budget-us", value}, 2, "--budget-us: give a positive number of microseconds");
    refuses({"--error", value}, 2, "--error: give a positive number of mesh units");
  }
  refuses({"--error", "x"}, 2, "--error");
  refuses({"--error", "0.1", "--axis", "w"}, 2, "--axis");
  refuses({"--error", "0.1", "--axis", "x", "--poses", poses({0})}, 2, "contradicts --poses");
  refuses({"--error", "0.1", "--workers", "3"}, 2, "--workers");
  refuses({"--error", "0.1", "--target", "none"}, 2, "none");
  refuses({"--error", "0.1", "--max-memory", "10"}, 2, "allow more");
  refuses({"--error", "0.1", "--voxel-size", "1"}, 2, "--voxel-size");
  refuses({"--error", "0.1", "--poses", path("none.json")}, 3, "none.json");
  refuses({"--error", "0.1", "--poses", write("bad.json", "[]")}, 3, "column by column");
}

TEST_F(Advise, BodiesThatAreNoUse) {
  IST_SLOW();
  const std::string tree = ball_tree();
  for (const auto& [fixed, moving] : {std::pair(tree, moving_), std::pair(fixed_, tree)}) {
    const CommandResult result = ist({"advise", fixed, moving, "--error", "0.1"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, "ball.ist: it is a tree, whose voxel size is fixed already"));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(ist({"advise", fixed_, path("none.stl"), "--error", "1"}).exit_code, 3);
  EXPECT_EQ(ist({"advise", fixed_, write("bad.stl", "solid"), "--error", "1"}).exit_code, 3);
  const std::string point = mesh("point.stl", triangle({1, 1, 1}, {1, 1, 1}, {1, 1, 1}));
  EXPECT_EQ(ist({"advise", point, point, "--error", "1"}).exit_code, 3);
  const std::string speck = mesh("speck.stl", icosphere(1, 1e-8));
  const CommandResult sizes = ist({"advise", fixed_, speck, "--error", "1"});
  EXPECT_EQ(sizes.exit_code, 3);
  EXPECT_TRUE(says(sizes.err, "times as large as "));
  // Bodies that go past each other on every axis.
  const std::string aside = mesh("aside.stl", moved(icosphere(2, 2), {5, 5, 5}));
  const CommandResult result = ist({"advise", fixed_, aside, "--error", "0.1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, "--poses: needed, because the bodies do not touch"));
}

}  // namespace
}  // namespace ist::test
