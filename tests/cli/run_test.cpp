// `ist run`: what it makes of a scene and of its flags.

#include <chrono>
#include <map>
#include <thread>

#include "cli/run_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

class Run : public RunCase {};

TEST_F(Run, TheShippedScenesAreSound) {
  IST_SLOW();
  for (const std::string scene : {"press", "slide"}) {
    const CommandResult result = ist_well(run(shipped(scene), {"--check"}));
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_TRUE(result.err.empty()) << result.err;
    const CommandResult ran =
        ist_well(run(shipped(scene), {"--unpaced", "--seconds", "0.5", "--json"}));
    const auto lines = json_lines(ran.out);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0]["ticks"], 500);
    EXPECT_EQ(lines[0]["missed"], 0);
    EXPECT_EQ(lines[0]["faults"], 0);
    EXPECT_EQ(lines[0]["rate"], 1000.0);
    EXPECT_GT(lines[0]["effects"][scene == "press" ? "springs" : "damping"], 0.0);
    for (const char* times : {"late_microseconds", "microseconds", "cpu_microseconds"}) {
      double last = 0;
      for (const char* quantile : {"p50", "p99", "p99.9", "p99.99", "max"}) {
        EXPECT_GE(lines[0][times][quantile], last) << times << ' ' << quantile;
        last = lines[0][times][quantile];
      }
    }
  }
  EXPECT_EQ(ist(run(coarse_jaws(), {"--check"})).exit_code, 0);
}

TEST_F(Run, PrintsWhatTicksTook) {
  const CommandResult result = ist_well(run(boxes(), {"--unpaced", "--seconds", "0.3"}));
  for (const char* part : {"300 ticks of 1000 µs: 0 deadlines missed, 0 ticks held, 0 faults",
                           "p99.99", "began late", "processor", "effects, a tick: damping "}) {
    EXPECT_TRUE(says(result.out, part));
  }
  EXPECT_TRUE(result.err.empty()) << result.err;
}

TEST_F(Run, ExplainsWhatIsBuiltAndWhatIsNot) {
  const CommandResult words = ist_well(run(shipped("press"), {"--explain"}));
  EXPECT_TRUE(says(words.out, "built    fixed tree"));
  EXPECT_TRUE(says(words.out, "skipped  proximity voxels"));
  EXPECT_TRUE(says(words.out, "no effect needs them"));
  const auto notes = [&](const std::string& scene) {
    std::map<std::string, nlohmann::json> by_name;
    for (const auto& line : json_lines(ist_well(run(scene, {"--explain", "--json"})).out)) {
      by_name[line["what"]] = line;
    }
    return by_name;
  };
  auto press = notes(shipped("press")), all = notes(all_effects());
  EXPECT_EQ(press["contact points"]["built"], true);
  EXPECT_GT(press["contact points"]["bytes"], 0);
  EXPECT_EQ(press["proximity voxels"]["built"], false);
  EXPECT_EQ(press["proximity voxels"]["bytes"], 0);
  for (const char* what : {"fixed tree", "held tree", "proximity voxels", "held tree, coarse",
                           "contact points", "proximity query"}) {
    EXPECT_EQ(all[what]["built"], true) << what;
  }
}

TEST_F(Run, ABadSceneIsABadInput) {
  const CommandResult unknown = ist(run(altered("press", "stiffness", "stifness"), {"--check"}));
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_TRUE(says(unknown.err, "press.toml:"));
  const CommandResult touching = ist(
      run(altered("press", "translation = [0, 0, 12]", "translation = [0, 0, 9]"), {"--check"}));
  EXPECT_EQ(touching.exit_code, 3);
  EXPECT_TRUE(says(touching.err, "open = \"-z\""));
  EXPECT_EQ(ist(run(path("none.toml"), {})).exit_code, 3);
}

TEST_F(Run, WarnsOfACouplingThatIsClamped) {
  const CommandResult result = ist_well(
      run(altered("press", "[effects.springs]", "[coupling]\nstiffness = 9e5\n[effects.springs]"),
          {"--check"}));
  EXPECT_TRUE(says(result.err, "coupling.stiffness of 9e+05 N/m is too near"));
}

// Springs of 10,000 N/m at voxels of 0.5 mm bear 2.5 N. The coupling exerts 5 N.
TEST_F(Run, SaysTheForceAtWhichSpringsBreak) {
  const std::string breaks = "breaks at 2.5 N, and the coupling exerts up to 5 N";
  const std::string weak = altered("press", "stiffness = 40000", "stiffness = 10000");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--check"}, {"--explain"}, {"--unpaced"}}) {
    const CommandResult refused = ist(run(weak, more));
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_TRUE(says(refused.err, "press.toml:26: "));
    EXPECT_TRUE(says(refused.err, breaks));
    EXPECT_TRUE(says(refused.err, "allow_breaking = true"));
  }
  const std::string allowed =
      altered("press", "stiffness = 40000", "stiffness = 10000\nallow_breaking = true");
  for (const std::string flag : {"--check", "--explain"}) {
    EXPECT_TRUE(says(ist_well(run(allowed, {flag})).err, breaks));
  }
}

// Its clock stands still for 50 ms or more: no machine keeps the 50 deadlines meanwhile.
TEST_F(Run, MissedDeadlinesEndWithTheirOwnCode) {
  IST_SLOW();
  for (const std::string allowed : {"20", "1000000"}) {
    const std::string file = path(allowed + ".jsonl");
    Process process = with_held_call(
        "clock_nanosleep", 100,
        run(boxes(), {"--seconds", "1", "--record", file, "--allow-missed", allowed, "--json"}));
    await_hold(process);
    std::this_thread::sleep_for(50ms);
    release();
    const CommandResult result = process.wait();
    const auto report = json_lines(result.out);
    ASSERT_EQ(report.size(), 1u);
    EXPECT_GE(report[0]["missed"], 40);
    EXPECT_EQ(report[0]["ticks"], json_lines(file_content(file)).size());
    EXPECT_EQ(result.exit_code, allowed == "20" ? 4 : 0) << result.err;
    if (allowed == "20") {
      EXPECT_TRUE(says(result.err, "deadlines were missed, and 20 are allowed: use larger voxels"));
    }
  }
}

TEST_F(Run, RefusesFlagsThatContradictEachOther) {
  const std::string scene = boxes(), file = path("a.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "0.01", "--record", file}));
  const std::vector<std::vector<std::string>> contradictions{
      {"--check", "--explain"},
      {"--unpaced", "--replay", file},
      {"--unpaced", "--cpu", "0"},
      {"--check", "--record", file},
      {"--explain", "--record", file},
      {"--check", "--replay", file},
      {"--explain", "--unpaced"},
      {"--check", "--unpaced"},
      {"--check", "--seconds", "1"},
      {"--replay", file, "--seconds", "1"},
      {"--replay", file, "--cpu", "0"},
      {"--replay", file, "--allow-missed", "1"},
      {"--unpaced", "--allow-missed", "1"}};
  for (const auto& flags : contradictions) {
    const CommandResult result = ist(run(scene, flags));
    EXPECT_EQ(result.exit_code, 2) << flags[0] << ' ' << flags[1] << ' ' << flags.back();
    EXPECT_TRUE(says(result.err, "--help"));
  }
  for (const auto& wrong : std::vector<std::vector<std::string>>{{"--rate", "0"},
                                                                 {"--rate", "20000"},
                                                                 {"--seconds", "0"},
                                                                 {"--seconds", "nan"},
                                                                 {"--rate", "nan"},
                                                                 {"--allow-missed", "-1"},
                                                                 {"--cpu", "-1"}}) {
    EXPECT_EQ(ist(run(scene, wrong)).exit_code, 2) << wrong[0] << ' ' << wrong[1];
  }
  EXPECT_EQ(ist({"run"}).exit_code, 2);
}

}  // namespace
}  // namespace ist::test
