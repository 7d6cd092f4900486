#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "cli/cli_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

/// `ist bench`, for as short a time as it takes.
class Bench : public CliTest {
 protected:
  static CommandResult bench(std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "--seconds", "0.01"});
    return ist(more);
  }
  static void refuses(const std::vector<std::string>& more, int exit_code,
                      const std::string& part) {
    SCOPED_TRACE(part);
    const CommandResult result = bench(more);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(result.out, "");
  }

  const std::string fixed_ = mesh("fixed.stl", icosphere(2, 2));
  const std::string moving_ = mesh("moving.stl", moved(icosphere(2, 2), {0.1, -3.65, 0.2}));
};

using Key = std::tuple<std::string, std::string, std::string, int, std::string>;

Key key_of(const json& line) {
  return {line.at("question"), line.at("way"),
          line.at("spheres").is_null() ? "" : line.at("spheres").get<std::string>(),
          line.at("workers"), line.at("at")};
}

TEST_F(Bench, ComparesTheSameSpheresAndThenTheTightest) {
  IST_SLOW();
  const CommandResult result = bench({"--voxel-size", "3", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto lines = json_lines(result.out);
  const json& machine = lines.front();
  EXPECT_FALSE(machine.at("processor").get<std::string>().empty());
  EXPECT_GE(machine.at("cores"), 1);
  EXPECT_EQ(machine.at("quiet").get<bool>(), machine.at("noise").is_null());
  EXPECT_GT(machine.at("loop_microseconds").at(0), 0);
  EXPECT_GT(machine.at("seconds"), 0.01);  // in three turns each
  std::map<Key, double> times;
  std::map<Key, json> listed;
  std::map<std::pair<std::string, std::string>, double> ratios;
  for (const json& line : lines) {
    if (line.contains("question")) {
      times[key_of(line)] = line.at("microseconds_median");
      listed[key_of(line)] = line.at("listed");
      EXPECT_GT(line.at("microseconds_median"), 0);
      EXPECT_GE(line.at("microseconds_p99"), line.at("microseconds_median"));
      EXPECT_GE(line.at("samples"), 3);
    } else if (line.contains("ratio")) {
      EXPECT_TRUE(ratios.try_emplace({line.at("ratio"), line.at("at")}, line.at("times")).second);
    }
  }
  // Four policies by the published query and by one worker and two; contacts by two ways; touch,
  // pairs of triangles and distance: each closed and apart.
  EXPECT_EQ(times.size(), 2u * (4 * 3 + 2 + 3));
  EXPECT_EQ(ratios.size(), 2u * (4 + 2 + 1));
  for (const char* at : {"closed", "apart"}) {
    const auto time = [&](const char* way, const char* spheres, int workers) {
      return times.at({"leaf pairs", way, spheres, workers, at});
    };
    for (const std::string policy : {"simple", "table", "tight", "slab"}) {
      EXPECT_DOUBLE_EQ(ratios.at({policy + " against " + policy, at}),
                       time("published", policy.c_str(), 1) / time("IST", policy.c_str(), 1));
    }
    EXPECT_DOUBLE_EQ(ratios.at({"slab against table", at}),
                     time("published", "table", 1) / time("IST", "slab", 1));
    EXPECT_DOUBLE_EQ(ratios.at({"slab against table, two workers", at}),
                     time("published", "table", 1) / time("IST", "slab", 2));
  }
  // The same pairs on both sides, but for those within the pads of float.
  for (const char* policy : {"simple", "tight", "slab"}) {
    const double published = listed.at({"leaf pairs", "published", policy, 1, "closed"}),
                 fast = listed.at({"leaf pairs", "IST", policy, 1, "closed"});
    EXPECT_GT(published, 0.98 * fast);
    EXPECT_LE(published, fast);
  }
  EXPECT_GT(listed.at({"leaf pairs", "published", "table", 1, "closed"}),
            listed.at({"leaf pairs", "IST", "slab", 1, "closed"}));
  EXPECT_GT(listed.at({"triangle pairs", "IST", "", 1, "closed"}), 0);
  EXPECT_EQ(listed.at({"triangle pairs", "IST", "", 1, "apart"}), 0);
  EXPECT_TRUE(listed.at({"distance", "IST", "", 1, "closed"}).is_null());
}

TEST_F(Bench, ShowsRatiosFirst) {
  const CommandResult result = bench({"--voxel-size", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* part :
       {"commit ", "governor ", "a fixed loop took ", "the built-in jaws: voxels of 3"}) {
    EXPECT_TRUE(says(result.out, part));
  }
  const std::size_t ratio = result.out.find("table against table"),
                    best = result.out.find("slab against table, two workers"),
                    time = result.out.find("leaf pairs, published, simple");
  ASSERT_NE(ratio, std::string::npos);
  EXPECT_LT(ratio, best);
  EXPECT_LT(best, time);
  EXPECT_NE(time, std::string::npos);
}

TEST_F(Bench, ClosesTheUsersBodies) {
  IST_SLOW();
  const CommandResult result = bench({fixed_, moving_, "--voxel-size", "0.2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json header = json::parse(result.out.substr(0, result.out.find('\n')));
  EXPECT_EQ(header.at("subcommand"), "bench");
  EXPECT_EQ(header.at("fixed").at("file"), "fixed.stl");
  std::map<Key, json> listed;
  for (const json& line : json_lines(result.out)) {
    if (line.contains("question")) listed[key_of(line)] = line.at("listed");
  }
  EXPECT_GT(listed.at({"triangle pairs", "IST", "", 1, "closed"}), 0);
  EXPECT_EQ(listed.at({"triangle pairs", "IST", "", 1, "apart"}), 0);
}

TEST_F(Bench, TakesPosesWithMostAndFewestPairs) {
  IST_SLOW();
  const std::string ball = ball_tree("ball.ist", "slab", {"--no-triangles"});
  const CommandResult result = bench({ball, ball, "--poses", poses({9, 1, 3.5}), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::set<std::string> questions;
  for (const json& line : json_lines(result.out)) {
    if (!line.contains("question")) continue;
    questions.insert(line.at("question"));
    if (line.at("question") == "leaf pairs") {
      EXPECT_EQ(line.at("listed") > 0, line.at("at") == "most") << line;
    }
  }
  EXPECT_EQ(questions,
            (std::set<std::string>{"contacts", "leaf pairs"}));  // triangles are not there
}

TEST_F(Bench, TakesPosesOfTheBuiltInJaws) {
  IST_SLOW();
  const CommandResult result = bench({"--voxel-size", "3", "--poses", poses({200, 0}), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, json> listed;
  for (const json& line : json_lines(result.out)) {
    if (line.value("question", "") == "leaf pairs") listed[line.at("at")] = line.at("listed");
  }
  EXPECT_GT(listed.at("most"), 0);
  EXPECT_EQ(listed.at("fewest"), 0);
}

TEST_F(Bench, RefusesPosesThatAreAllAlike) {
  refuses({fixed_, fixed_, "--voxel-size", "0.5", "--poses", poses({1, 1, 1})}, 3,
          "poses.json: each of its 3 poses has ");
}

TEST_F(Bench, RefusesAFileWithoutPoses) {
  refuses({fixed_, moving_, "--voxel-size", "0.5", "--poses", poses({})}, 3,
          "poses.json: give an array of objects");
  refuses({"--voxel-size", "3", "--poses", write("empty.json", "")}, 3,
          "empty.json: not JSON: parse error");
  refuses({"--voxel-size", "3", "--poses", write("words.json", "no")}, 3,
          "invalid literal; last read: 'no'; give an array of objects with");
}

TEST_F(Bench, KeepsToItsMemory) {
  for (const std::vector<std::string>& bodies :
       {std::vector<std::string>{}, {fixed_, moving_, "--voxel-size", "0.1"}}) {
    std::vector<std::string> arguments = bodies;
    arguments.insert(arguments.end(), {"--max-memory", "10K"});
    refuses(arguments, 2, "allow more");
  }
}

// Four policies in three ways, each in three turns of 0.01 s, take longer than that.
TEST_F(Bench, SaysThatItTookLongerThanAsked) {
  IST_SLOW();
  const CommandResult result = bench({"--voxel-size", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, " s instead of 0.01: three turns of each query are the least\n"));
}

TEST_F(Bench, RefusesBodiesThatNeverMeet) {
  IST_SLOW();
  const std::string beside = mesh("beside.stl", moved(icosphere(2, 2), {100, 100, 100}));
  refuses({fixed_, beside}, 2, "--poses: needed, because the bodies never meet on the way");
  refuses({fixed_, moving_, "--poses", poses({50, 60})}, 3,
          "the bodies meet at none of its 2 poses");
  const std::string bare = ball_tree("bare.ist", "slab", {"--no-triangles"});
  refuses({bare, bare}, 2, "--poses: needed, because a tree holds no triangles");
}

TEST_F(Bench, RefusesWhatItCannotDo) {
  refuses({fixed_}, 2, "give both bodies, or none");
  for (const char* seconds : {"0", "-1", "nan", "inf", "4000"}) {
    const CommandResult result = ist({"bench", "--seconds", seconds});
    EXPECT_EQ(result.exit_code, 2) << seconds;
    EXPECT_TRUE(says(result.err, "--seconds"));
  }
  refuses({"--voxel-size", "-1"}, 2, "--voxel-size");
  refuses({"--against", "nobody"}, 2, "--against");
  refuses({path("none.stl"), moving_}, 3, "none.stl");
}

// The tests' own command is built without benchmarks.
TEST_F(Bench, NamesTheRemedyForALibraryThatIsNotBuiltIn) {
  for (const char* name : {"fcl", "embree"}) {
    refuses({"--against", name}, 2, std::string("this ist was built without ") + name);
  }
  refuses({"--against", "embree,fcl"}, 2, "./scripts/setup.sh --peers");
}

}  // namespace
}  // namespace ist::test
