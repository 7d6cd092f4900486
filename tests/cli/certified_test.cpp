#include "cli/cli_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

// --exact, --gap and --max-tests.
class Certified : public CliTest {
 protected:
  std::vector<json> ask(const std::string& fixed, const std::string& moving,
                        std::vector<std::string> more) const {
    std::vector<std::string> arguments{"collide", fixed, moving, "--poses", list_, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json_lines(ist_well(arguments).out);
  }
  void refuses(std::vector<std::string> more, const std::string& part) const {
    std::vector<std::string> arguments{"collide", ball_,          ball_, "--poses",
                                       list_,     "--voxel-size", "0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(says(result.err, part));
  }

  const std::string ball_ = ball();  // of radius 2
  const std::string list_ = poses({0, 3.5, 4.5, 100});
};

TEST_F(Certified, ExactFindsTheTrianglesThatMeet) {
  const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--exact"});
  ASSERT_EQ(lines.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(lines[i]["colliding"], i < 2);
    EXPECT_EQ(lines[i]["triangle_pairs"] > 0, i < 2);
    EXPECT_EQ(lines[i]["inside"], i < 2 ? json(nullptr) : json("none"));
    EXPECT_TRUE(lines[i]["complete"]);
  }
}

TEST_F(Certified, ExactTellsWhoIsInside) {
  const std::string small = mesh("small.stl", box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  EXPECT_EQ(ask(ball_, small, {"--voxel-size", "0.5", "--exact"})[0]["inside"], "moving");
  EXPECT_EQ(ask(small, ball_, {"--voxel-size", "0.5", "--exact"})[0]["inside"], "fixed");
  const CommandResult words = ist_well({"collide", ball_, small, "--poses", list_, "--voxel-size",
                                        "0.5", "--exact", "--gap", "0.1"});
  EXPECT_TRUE(says(words.out, "the moving body is inside"));
  EXPECT_TRUE(says(words.out, "0 pairs of triangles"));
  EXPECT_TRUE(says(words.out, "gap "));
}

TEST_F(Certified, ExactNeedsTriangles) {
  const std::string plain = ball_tree("plain.ist", "slab"), exact = path("exact.ist");
  const CommandResult result = ist({"collide", plain, plain, "--poses", list_, "--exact"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, "--exact"));
  EXPECT_TRUE(says(result.err, "FIXED"));
  ist_well({"build", ball_, "-o", exact, "--voxel-size", "0.5", "--exact"});
  EXPECT_GT(ask(exact, exact, {"--exact"})[1]["triangle_pairs"], 0);
}

TEST_F(Certified, GapHoldsTheDistance) {
  const std::string plain = ball_tree("plain.ist", "tight");
  for (const auto& lines : {ask(ball_, ball_, {"--voxel-size", "0.5", "--gap", "0.01"}),
                            ask(plain, plain, {"--gap", "0.01"})}) {
    EXPECT_EQ(lines[1]["gap_lower"], 0);
    EXPECT_NEAR(lines[3]["gap_lower"].get<double>(), 96, 2);
    for (const json& line : lines) EXPECT_LE(line["gap_lower"], line["gap_upper"]);
  }
  const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--gap", "0.01"});
  EXPECT_LE(lines[2]["gap_upper"].get<double>() - lines[2]["gap_lower"].get<double>(), 0.0101);
  EXPECT_GE(lines[2]["gap_lower"], 0.45);
}

TEST_F(Certified, DepthIsThatOfTheDeepestPoint) {
  const std::string small = mesh("small.stl", box({-0.5, -0.5, 1.5}, {0.5, 0.5, 2.5}));
  const auto lines = ask(ball_, small, {"--voxel-size", "0.2", "--depth", "0.001"});
  const json& stored = lines[0];
  EXPECT_LE(stored["depth_upper"].get<double>() - stored["depth_lower"].get<double>(), 0.00101);
  EXPECT_LE(stored["depth_at_vertices"], stored["depth_upper"]);
  EXPECT_TRUE(stored["contact_depth"].is_number());
  for (const json& line : lines) {
    EXPECT_EQ(line["depth_upper"] == 0, line["contact_depth"].is_null() || !line["colliding"]);
  }
  const CommandResult words = ist_well(
      {"collide", ball_, small, "--poses", list_, "--voxel-size", "0.2", "--depth", "0.01"});
  EXPECT_TRUE(says(words.out, "penetration depth "));
  EXPECT_TRUE(says(words.out, "at vertices"));
}

TEST_F(Certified, DepthNeedsClosedBodies) {
  const std::string open = mesh("open.stl", open_strip(4));
  const CommandResult result =
      ist({"collide", ball_, open, "--poses", list_, "--voxel-size", "0.5", "--depth", "0.1"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(says(result.err, "MOVING"));
  EXPECT_TRUE(says(result.err, "ist info"));
}

TEST_F(Certified, FirstContactIsFoundBetweenTheSteps) {
  const std::string small = mesh("small.stl", box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const std::string plate = mesh("plate.stl", box({-3, -3, 0}, {3, 3, 1}));
  const std::vector<std::string> words = {"close", plate,    small, "--voxel-size", "0.5", "--axis",
                                          "z",     "--from", "9",   "--to",         "-9",  "--step",
                                          "6"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return ist_well(all).out;
  };
  const std::string told = with({"--first-contact", "1e-4", "--json"});
  const json last = json::parse(told.substr(told.rfind('{', told.size() - 3)));
  EXPECT_EQ(last["first_contact"], "contact");
  EXPECT_LE(last["displacement_lower"].get<double>(), 1.5);
  EXPECT_GE(last["displacement_upper"].get<double>(), 1.5);
  EXPECT_LE(last["displacement_upper"].get<double>() - last["displacement_lower"].get<double>(),
            1.01e-4);
  EXPECT_EQ(last["triangles"].size(), 2U);
  EXPECT_TRUE(says(with({"--first-contact", "0.01"}), "first contact: displacement 1.5"));
}

TEST_F(Certified, MaxTestsStopsAndSaysWhatIsKnown) {
  const auto all = ask(ball_, ball_, {"--voxel-size", "0.5"});
  for (const char* tests : {"0", "1", "40", "1000000"}) {
    const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--max-tests", tests});
    for (std::size_t i = 0; i < 4; ++i) {
      const json& line = lines[i];
      EXPECT_LE(line["sphere_tests"], std::max(1, std::stoi(tests)));
      EXPECT_GE(line["gap_upper"], line["gap_lower"]);
      if (line["complete"]) {
        EXPECT_EQ(line["contacts"], all[i]["contacts"]);
        EXPECT_EQ(line["level"], 0);
      } else {
        EXPECT_GT(line["level"], 0);
        EXPECT_EQ(line["gap_lower"], 0);
        EXPECT_EQ(line["colliding"].is_null(), line["contacts"] == 0);
      }
    }
    EXPECT_EQ(lines[0]["complete"], std::stoi(tests) == 1000000);
    EXPECT_TRUE(lines[3]["complete"]);  // the roots are apart
  }
  const CommandResult words = ist_well(
      {"collide", ball_, ball_, "--poses", list_, "--voxel-size", "0.5", "--max-tests", "40"});
  EXPECT_TRUE(says(words.out, "stopped at level"));
}

TEST_F(Certified, ContradictionsAreRefused) {
  refuses({"--max-tests", "5", "--exact"}, "contradicts");
  refuses({"--max-tests", "5", "--gap", "1"}, "contradicts");
  refuses({"--max-tests", "5", "--verify"}, "contradicts");
  refuses({"--max-tests", "-5"}, "decimal digits");
  refuses({"--max-tests", "010"}, "decimal digits");
  refuses({"--max-tests", "1.5"}, "--max-tests");
  refuses({"--gap", "-1"}, "--gap");
  refuses({"--gap", "nan"}, "--gap");
  for (const auto& flag :
       {std::vector<std::string>{"--exact"}, {"--gap", "1"}, {"--max-tests", "1"}}) {
    std::vector<std::string> with = flag;
    with.insert(with.end(), {"--engine", "reference"});
    refuses(with, "--engine simd");
  }
}

}  // namespace
}  // namespace ist::test
