#include <map>
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

  /// By question, way, bounds and workers.
  using Rows = std::map<std::tuple<std::string, std::string, std::string, int>, json>;
  static Rows rows(std::vector<std::string> more) {
    more.push_back("--json");
    const CommandResult result = bench(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    Rows all;
    for (const json& line : json_lines(result.out)) {
      const bool is_new = all.try_emplace({line.at("question"), line.at("way"), line.at("spheres"),
                                           line.at("workers").get<int>()},
                                          line)
                              .second;
      EXPECT_TRUE(is_new) << line;
      EXPECT_GE(line.at("microseconds_p90"), line.at("microseconds_median"));
      EXPECT_GE(line.at("microseconds_p99"), line.at("microseconds_p90"));
      EXPECT_GT(line.at("microseconds_p99"), 0);
    }
    return all;
  }

  const std::string fixed_ = mesh("fixed.stl", icosphere(2, 2));
  const std::string moving_ = mesh("moving.stl", moved(icosphere(2, 2), {0.1, -3.65, 0.2}));
};

TEST_F(Bench, ComparesEachPolicyOfTheBuiltInJaws) {
  IST_SLOW();
  const Rows all = rows({"--voxel-size", "3"});
  EXPECT_EQ(all.size(), 4u * 3 + 3);
  for (const char* policy : {"simple", "table", "tight", "slab"}) {
    const json& published = all.at({"leaf pairs", "published", policy, 1});
    EXPECT_EQ(published.at("times"), 1);
    for (const int workers : {1, 2}) {
      const json& fast = all.at({"leaf pairs", "IST", policy, workers});
      EXPECT_GE(fast.at("samples"), 3 * 12);
      // A time has three digits behind the point, and a ratio two.
      const double ratio = published.at("microseconds_median").get<double>() /
                           fast.at("microseconds_median").get<double>();
      EXPECT_NEAR(fast.at("times").get<double>(), ratio, 0.005 + 0.01 * ratio) << fast;
      // The same pairs, but for those within the pads of float.
      if (std::string(policy) == "table") continue;
      EXPECT_LE(published.at("listed"), fast.at("listed"));
      EXPECT_GT(published.at("listed").get<double>(), 0.97 * fast.at("listed").get<double>());
    }
  }
  EXPECT_GT(all.at({"triangle pairs", "IST", "", 1}).at("listed"), 0);
  for (const char* question : {"touch", "distance"}) {
    EXPECT_TRUE(all.at({question, "IST", "", 1}).at("listed").is_null());
    EXPECT_TRUE(all.at({question, "IST", "", 1}).at("times").is_null());
  }
}

TEST_F(Bench, PrintsARowForEachWay) {
  const CommandResult result = bench({fixed_, moving_, "--voxel-size", "0.5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "12 poses: opening towards -y"));
  EXPECT_TRUE(result.out.starts_with("question       by        bounds  workers     pairs"));
  EXPECT_TRUE(says(result.out, "\nleaf pairs     published slab          1"));
  EXPECT_TRUE(says(result.out, "\nleaf pairs     IST       slab          2"));
  EXPECT_TRUE(says(result.out, "\ntriangle pairs IST                     1"));
}

// Each pose counts once: the lists of two poses are as long as the lists of each together.
TEST_F(Bench, AsksAtEachPoseOfAFile) {
  IST_SLOW();
  const std::string ball = ball_tree("ball.ist", "slab", {"--no-triangles"});
  const auto listed = [&](const std::vector<double>& shifts) {
    const Rows all = rows({ball, ball, "--poses", poses(shifts)});
    EXPECT_EQ(all.size(), 4u * 3);  // the trees hold no triangles
    return all.at({"leaf pairs", "IST", "slab", 1}).at("listed").get<std::uint64_t>();
  };
  const std::uint64_t near = listed({1}), far = listed({3.5});
  EXPECT_GT(near, 0u);
  EXPECT_EQ(listed({1, 3.5, 1}), 2 * near + far);
  EXPECT_EQ(listed({9}), 0u);
}

TEST_F(Bench, NamesTheUsersFiles) {
  const CommandResult result = bench({fixed_, moving_, "--voxel-size", "0.5", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json header = json::parse(result.out.substr(0, result.out.find('\n')));
  EXPECT_EQ(header.at("subcommand"), "bench");
  EXPECT_EQ(header.at("fixed").at("file"), "fixed.stl");
}

TEST_F(Bench, RefusesAFileWithoutPoses) {
  refuses({fixed_, moving_, "--voxel-size", "0.5", "--poses", poses({})}, 3,
          "poses.json: give an array of objects");
  refuses({"--voxel-size", "3", "--poses", write("empty.json", "")}, 3,
          "empty.json: not JSON: parse error");
}

TEST_F(Bench, KeepsToItsMemory) {
  refuses({"--max-memory", "10K"}, 2, "allow more");
  refuses({fixed_, moving_, "--voxel-size", "0.1", "--max-memory", "10K"}, 2, "allow more");
}

TEST_F(Bench, RefusesBodiesThatNeverMeet) {
  IST_SLOW();
  const std::string beside = mesh("beside.stl", moved(icosphere(2, 2), {100, 100, 100}));
  refuses({fixed_, beside}, 2, "--poses: needed, because the bodies do not touch");
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
  refuses({"--voxel-size", "0"}, 2, "--voxel-size: 0 is no size");
  refuses({"--voxel-size", "-1"}, 2, "voxel size -1: give a positive number");
  refuses({"--against", "fcl"}, 2, "--against: no such option");
  refuses({path("none.stl"), moving_}, 3, "none.stl");
}

}  // namespace
}  // namespace ist::test
