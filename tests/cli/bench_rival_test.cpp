// `ist bench --against`, by a command that has a library to ask: tests/cli/fake_rival.cpp.
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/cli_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class BenchRival : public CliTest {
 protected:
  static CommandResult bench(std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "--seconds", "0.01", "--against", "fake"});
    return run_command(IST_COMMAND_WITH_RIVAL, more);
  }

  const std::string fixed_ = mesh("fixed.stl", icosphere(2, 2));
  const std::string moving_ = mesh("moving.stl", moved(icosphere(1, 2), {0.1, -3.6, 0.2}));
};

TEST_F(BenchRival, IsAskedTheSameQuestions) {
  const CommandResult result = bench({fixed_, moving_, "--voxel-size", "0.5", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, json> asked, own, ratios;  // by question and pose
  for (const json& line : json_lines(result.out)) {
    const std::string at = line.value("at", "");
    if (line.value("way", "") == "fake") asked[line["question"].get<std::string>() + at] = line;
    if (line.value("way", "") == "IST") own[line["question"].get<std::string>() + at] = line;
    if (line.contains("ratio")) ratios[line["ratio"].get<std::string>() + ", " + at] = line;
  }
  ASSERT_EQ(asked.size(), 4u);
  EXPECT_EQ(asked.at("triangle pairsclosed").at("listed"), 320);  // triangles of the fixed body
  EXPECT_EQ(asked.at("triangle pairsapart").at("listed"), 80);    // and of the moving one
  EXPECT_TRUE(asked.at("touchapart").at("listed").is_null());
  for (const auto& [question, microseconds] : {std::pair("touch", 5e3), {"triangle pairs", 7e3}}) {
    for (const std::string at : {"closed", "apart"}) {
      EXPECT_EQ(asked.at(question + at).at("microseconds_median"), microseconds);
      const json& ratio = ratios.at(question + std::string(", against fake, ") + at);
      EXPECT_DOUBLE_EQ(
          ratio.at("times").get<double>(),
          microseconds / own.at(question + at).at("microseconds_median").get<double>());
    }
  }
}

TEST_F(BenchRival, IsNamedWithItsVersion) {
  IST_SLOW();
  const CommandResult result = bench({fixed_, moving_, "--voxel-size", "0.5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, "\nbeside fake 1.2, in one thread\n"));
  EXPECT_TRUE(says(result.out, "triangles: IST against other libraries\n  touch, against fake "));
  EXPECT_TRUE(says(result.out, "touch, fake "));
}

TEST_F(BenchRival, NeedsTriangles) {
  const std::string bare = ball_tree("bare.ist", "slab", {"--no-triangles"}), whole = ball_tree();
  for (const auto& [fixed, moving] : {std::pair(bare, whole), {whole, bare}}) {
    const CommandResult result = bench({fixed, moving, "--poses", poses({1, 3.5})});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, "bare.ist: the tree has no triangles"));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(BenchRival, IsRefusedWhereOneOfThemIsNotBuiltIn) {
  const CommandResult result = bench({"--against", "absent"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, "this ist was built without absent"));
}

}  // namespace
}  // namespace ist::test
