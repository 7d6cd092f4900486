#include <fstream>
#include <tuple>

#include "cli/cli_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

// What collide and approach tell people.
class Answers : public CliTest {
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
  [[nodiscard]] std::string tree_without_triangles(const std::string& name) const {
    ist_well({"build", ball_, "-o", path(name), "--voxel-size", "0.5", "--no-triangles"});
    return path(name);
  }
  [[nodiscard]] std::string cube(double half) const {
    return mesh("cube.stl", box({-half, -half, -half}, {half, half, half}));
  }
  static bool has_note(const json& line, const std::string& part) {
    for (const json& note : line["notes"]) {
      if (note.get<std::string>().find(part) != std::string::npos) return true;
    }
    return false;
  }

  const std::string ball_ = ball();  // of radius 2
  const std::string list_ = poses({0, 3.5, 4.5, 100});
};

TEST_F(Answers, TouchIsCertainByDefault) {
  for (const json& line : ask(ball_, ball_, {"--voxel-size", "0.5"})) {
    const bool meets = line["index"] < 2;
    EXPECT_EQ(line["touch"], meets ? "yes" : "no");
    EXPECT_EQ(line["inside"], "none");
    EXPECT_TRUE(line["triangle_pairs"].is_null());
    EXPECT_TRUE(line["notes"].empty());
  }
  // Voxels overlap long before the surfaces meet.
  const auto coarse = ask(ball_, ball_, {"--voxel-size", "2"});
  EXPECT_GT(coarse[2]["leaf_pairs"], 0);
  EXPECT_EQ(coarse[2]["touch"], "no");
}

TEST_F(Answers, NearIsSaidWithoutTriangles) {
  const std::string plain = tree_without_triangles("plain.ist");
  const auto lines = ask(plain, plain, {"--distance", "0.01"});
  EXPECT_EQ(lines[1]["touch"], "near");
  EXPECT_TRUE(has_note(lines[1], "at most "));
  EXPECT_EQ(lines[3]["touch"], "no");
  for (const json& line : lines) {
    EXPECT_TRUE(line["depth_lower"].is_null() && line["depth_upper"].is_null());
    EXPECT_TRUE(line["area"].is_null());
    EXPECT_EQ(line["touch"] != "no",
              has_note(line, "depth is not known: plain.ist holds no triangles"));
    EXPECT_LE(line["distance_lower"], line["distance_upper"]);
  }
  EXPECT_TRUE(lines[1]["inside"].is_null());
  EXPECT_EQ(lines[3]["inside"], "none");  // the boxes of the bodies are apart
  EXPECT_TRUE(has_note(lines[2], "asked to 0.01, reached "));
  EXPECT_TRUE(has_note(lines[2], "build with triangles"));
  const CommandResult words = ist_well({"collide", plain, plain, "--move", "3.5,0,0"});
  EXPECT_TRUE(says(words.out, "near"));
  EXPECT_TRUE(says(words.out, " apart"));
}

// One question, one answer, whatever else is asked.
TEST_F(Answers, WithoutTrianglesVoxelsAnswerWhateverIsAsked) {
  IST_SLOW();
  const std::string plain = tree_without_triangles("plain.ist");
  for (const auto& [shift, code, touch] :
       {std::tuple("3.9,0,0", 6, "near"), std::tuple("5.5,0,0", 0, "no")}) {
    std::vector<std::string> words{"collide", plain, ball_, "--move", shift, "--fail-if-touching"};
    const CommandResult people = ist(words);
    EXPECT_EQ(people.exit_code, code) << people.out;
    EXPECT_TRUE(says(people.out, std::string("touch      ") + touch));
    EXPECT_TRUE(says(people.err, "voxel size 0.008"));
    EXPECT_EQ(code == 6, says(people.err, "ist: the bodies may touch\n"));
    words.emplace_back("--json");
    const CommandResult lines = ist(words);
    EXPECT_EQ(lines.exit_code, code);
    EXPECT_EQ(json_lines(lines.out).at(0)["touch"], touch);
  }
}

TEST_F(Answers, ExactCountsTheTrianglesThatMeet) {
  const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--exact"});
  ASSERT_EQ(lines.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(lines[i]["triangle_pairs"] > 0, i < 2);
  const CommandResult words =
      ist_well({"collide", ball_, ball_, "--voxel-size", "0.5", "--move", "3.5,0,0", "--exact"});
  EXPECT_TRUE(says(words.out, " pairs meet"));
  const std::string plain = tree_without_triangles("plain.ist");
  for (const std::vector<std::string>& asked :
       {std::vector<std::string>{"--exact"}, {"--depth", "0.1"}}) {
    std::vector<std::string> arguments{"collide", plain, plain};
    arguments.insert(arguments.end(), asked.begin(), asked.end());
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, "plain.ist: the tree has no triangles"));
    EXPECT_TRUE(says(result.err, "--no-triangles"));
  }
}

TEST_F(Answers, EscapeTellsTheMotionThatFrees) {
  const std::string small = cube(0.5);
  const auto asked = json_lines(ist_well({"collide", ball_, small, "--escape", "--json"}).out);
  const json& escape = asked.at(0)["escape"];
  EXPECT_EQ(escape["status"], "found");
  EXPECT_LE(escape["lower"], escape["upper"]);
  EXPECT_GE(escape["lower"], asked[0]["depth_lower"]);
  EXPECT_EQ(escape["motion"].size(), 16u);
  // The pose after it is free.
  const auto write = [&](const std::string& text) {
    std::ofstream(path("freed.json")) << "[{\"pose\": " << text << "}]";
  };
  write(escape["pose"].dump());
  const std::vector<std::string> again{"collide",          ball_,      small,   "--poses",
                                       path("freed.json"), "--escape", "--json"};
  const auto freed = json_lines(ist_well(again).out);
  EXPECT_EQ(freed.at(0)["touch"], "no");
  EXPECT_EQ(freed[0]["inside"], "none");
  EXPECT_EQ(freed[0]["escape"]["status"], "not-needed");
  EXPECT_EQ(freed[0]["escape"]["upper"], 0);
  const CommandResult words = ist_well({"collide", ball_, small, "--escape"});
  EXPECT_TRUE(says(words.out, "\nescape     ")) << words.out;
  const CommandResult few = ist_well({"collide", ball_, small, "--escape", "--max-tests", "1"});
  EXPECT_TRUE(says(few.out, "no motion was found")) << few.out;
  EXPECT_TRUE(says(few.out, "allow more --max-tests"));
  const std::string plain = tree_without_triangles("plain.ist");
  EXPECT_EQ(ist({"collide", plain, plain, "--escape"}).exit_code, 2);
}

TEST_F(Answers, InsideIsTold) {
  const std::string small = cube(0.5);
  const auto in_ball = ask(ball_, small, {"--voxel-size", "0.5"});
  EXPECT_EQ(in_ball[0]["inside"], "moving");
  EXPECT_EQ(in_ball[0]["touch"], "no");
  EXPECT_GT(in_ball[0]["distance_lower"], 1);
  EXPECT_GT(in_ball[0]["depth_lower"], 1.4);               // its far corner's way out
  EXPECT_NEAR(in_ball[0]["area"].get<double>(), 3, 1e-6);  // the mean of 6 and nothing
  EXPECT_EQ(ask(small, ball_, {"--voxel-size", "0.5"})[0]["inside"], "fixed");
  EXPECT_EQ(in_ball[3]["inside"], "none");
  const CommandResult words = ist_well({"collide", ball_, small, "--voxel-size", "0.5"});
  EXPECT_TRUE(says(words.out, "the moving body is inside"));
  EXPECT_TRUE(says(words.out, "nearest    ("));
}

// An open body has no inside: nothing is told of what might be in it.
TEST_F(Answers, AnOpenBodyHasNoInsideAndADepthByVertices) {
  TriangleMesh open = box({-2, -2, -2}, {2, 2, 2});
  open.triangles.pop_back();
  const std::string shell = mesh("shell.stl", open), small = cube(0.5);
  const auto lines = ask(shell, small, {"--voxel-size", "0.25"});
  EXPECT_EQ(lines[0]["touch"], "no");
  EXPECT_TRUE(lines[0]["inside"].is_null());
  EXPECT_TRUE(has_note(lines[0], "inside is not known: shell.stl is open"));
  EXPECT_EQ(lines[3]["inside"], "none");
  EXPECT_TRUE(lines[3]["notes"].empty());
  // A corner of the cube, 0.01 behind a face: within the reach of an open body.
  const CommandResult words =
      ist_well({"collide", shell, small, "--voxel-size", "0.25", "--move", "2.49,0,0"});
  EXPECT_TRUE(says(words.out, "at least 0.01 (open surface, by vertices)"));
  const json met = json_lines(ist_well({"collide", shell, small, "--voxel-size", "0.25", "--move",
                                        "2.49,0,0", "--json"})
                                  .out)
                       .at(0);
  EXPECT_EQ(met["touch"], "yes");
  EXPECT_TRUE(met["depth_lower"].is_null() && met["depth_upper"].is_null());
  EXPECT_NEAR(met["depth_at_vertices"].get<double>(), 0.01, 1e-6);
  EXPECT_NEAR(met["depth_point"][0].get<double>(), 1.99, 1e-6);
  EXPECT_TRUE(has_note(met, "depth is a lower bound, measured at vertices: shell.stl is open"));
  // Calm: one line about both, and a note once below the rows.
  const CommandResult rows =
      ist_well({"approach", shell, shell, "--axis", "x", "--from", "0.1", "--to", "0.3"});
  const std::string note = "depth is not known: shell.stl and shell.stl are open";
  EXPECT_TRUE(says(rows.out, "note: " + note)) << rows.out;
  EXPECT_EQ(rows.out.find(note), rows.out.rfind(note)) << rows.out;
  EXPECT_EQ(without_notes(rows.err), "");
  EXPECT_EQ(rows.err.find("open"), std::string::npos) << rows.err;
}

TEST_F(Answers, DistanceIsAsSharpAsAsked) {
  const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--distance", "0.01"});
  EXPECT_EQ(lines[1]["distance_upper"], 0);
  EXPECT_NEAR(lines[3]["distance_lower"].get<double>(), 96, 0.1);
  EXPECT_LE(lines[2]["distance_upper"].get<double>() - lines[2]["distance_lower"].get<double>(),
            0.0101);
  EXPECT_GE(lines[2]["distance_lower"], 0.45);
  // A tolerance below rounding is reached as far as there are digits, and the narrowest is told.
  const auto sharp = ask(ball_, ball_, {"--voxel-size", "0.5", "--distance", "0"});
  EXPECT_LE(sharp[2]["distance_upper"].get<double>() - sharp[2]["distance_lower"].get<double>(),
            sharp[2]["distance_narrowest"]);
  EXPECT_GT(sharp[2]["distance_narrowest"], 0);
}

TEST_F(Answers, DepthIsThatOfTheDeepestPoint) {
  const std::string small = mesh("small.stl", box({-0.5, -0.5, 1.5}, {0.5, 0.5, 2.5}));
  const auto lines = ask(ball_, small, {"--voxel-size", "0.2", "--depth", "0.001"});
  const json& stored = lines[0];
  EXPECT_LE(stored["depth_upper"].get<double>() - stored["depth_lower"].get<double>(), 0.00101);
  EXPECT_LE(stored["depth_at_vertices"], stored["depth_upper"]);
  EXPECT_EQ(stored["depth_point"].size(), 3u);
  EXPECT_TRUE(stored["contact_depth"].is_number());
  EXPECT_GT(stored["area"], 0);
  for (const json& line : lines) {
    EXPECT_EQ(line["depth_upper"] == 0, line["contact_depth"].is_null() || line["touch"] == "no");
  }
  // Neither depends on the voxels.
  const auto coarse = ask(ball_, small, {"--voxel-size", "0.5", "--depth", "0.001"});
  for (const char* key : {"depth_lower", "depth_upper", "area"}) {
    EXPECT_NEAR(coarse[0][key].get<double>(), stored[key].get<double>(), 1e-9) << key;
  }
  const CommandResult words = ist_well({"collide", ball_, small, "--voxel-size", "0.2"});
  EXPECT_TRUE(says(words.out, "depth "));
  EXPECT_TRUE(says(words.out, " at ("));
}

TEST_F(Answers, FirstContactIsFoundBetweenTheSteps) {
  const std::string small = cube(0.5), plate = mesh("plate.stl", box({-3, -3, 0}, {3, 3, 1}));
  const std::vector<std::string> words = {"approach", plate,    small,    "--voxel-size", "0.5",
                                          "--axis",   "-z",     "--from", "-9",           "--to",
                                          "9",        "--step", "6"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return ist_well(all).out;
  };
  const auto lines = json_lines(with({"--first-contact", "1e-4", "--json"}));
  const json& last = lines.back();
  EXPECT_EQ(last["first_contact"], "contact");
  EXPECT_LE(last["displacement_lower"].get<double>(), -1.5);
  EXPECT_GE(last["displacement_upper"].get<double>(), -1.5);
  EXPECT_LE(last["displacement_upper"].get<double>() - last["displacement_lower"].get<double>(),
            1.01e-4);
  EXPECT_EQ(last["triangles"].size(), 2U);
  EXPECT_NEAR(last["contact_fixed"][2].get<double>(), 1, 1e-12);
  EXPECT_NEAR(last["contact_moving"][2].get<double>(), 1, 1e-4);
  EXPECT_NEAR(last["contact_normal"][2].get<double>(), 1, 1e-6);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0]["displacement"], -9);
  EXPECT_EQ(lines[0]["pose"][14], 9);  // along -z
  EXPECT_TRUE(says(with({"--first-contact", "0.01"}), "first contact: displacement -1.5"));
  EXPECT_TRUE(says(with({}), "first contact: displacement -1.5"));
  EXPECT_TRUE(says(with({}), ", 1.000)\n"));
  const auto between = [&](const std::string& from, const std::string& to) {
    std::vector<std::string> all = words;
    all[8] = from;
    all[10] = to;
    all.emplace_back("--json");
    return json_lines(ist_well(all).out).back();
  };
  const json away = between("-3", "-9");
  EXPECT_EQ(away["first_contact"], "none");
  for (const char* key : {"contact_fixed", "contact_moving", "contact_normal"}) {
    EXPECT_TRUE(away[key].is_null()) << away;
  }
  // Triangles meet at the start: there is a place, and no normal.
  const json start = between("-1.25", "9");
  EXPECT_EQ(start["first_contact"], "touches-at-start");
  EXPECT_EQ(start["contact_fixed"], start["contact_moving"]);
  EXPECT_TRUE(start["contact_fixed"].is_array() && start["contact_normal"].is_null()) << start;
  // From the pose that is named on: half a unit is gone already.
  EXPECT_TRUE(says(with({"--move", "0,0,-0.5"}), "first contact: displacement -2.0"));
  const std::string plain = tree_without_triangles("plain.ist");
  EXPECT_TRUE(
      says(ist_well({"approach", plain, plain, "--axis", "x", "--from", "9", "--to", "8"}).out,
           "not known without triangles"));
}

// A horizontal triangle goes through another one between two poses in double.
TEST_F(Answers, TrianglesThatPassThroughEachOtherMeet) {
  const std::string face = mesh("face.stl", triangle({-1, -1, 0.1}, {1, -1, 0.1}, {0, 1, 0.1}));
  const std::string small =
      mesh("small.stl", triangle({-0.3, -0.2, 0}, {0.3, -0.2, 0}, {0, 0.2, 0}));
  const auto between = [&](const char* from, const char* to) {
    const auto told =
        ist_well({"approach", face, small, "--axis", "z", "--from", from, "--to", to, "--json"});
    return json_lines(told.out).back();
  };
  const json found = between("3", "-3");
  EXPECT_EQ(found["first_contact"], "contact") << found;
  EXPECT_EQ(found["passes"], true);
  EXPECT_EQ(found["grazed"], false);
  const json none = between("3", "1");
  EXPECT_EQ(none["first_contact"], "none");
  EXPECT_EQ(none["passes"], false);
}

TEST_F(Answers, SelfIntersectionsAreTold) {
  const std::string small = cube(0.25);
  const TriangleMesh two = joined(box({-1, -1, -1}, {1, 1, 1}), box({0, -2, -2}, {3, 2, 2}));
  const std::string crossed = mesh("crossed.stl", two);
  for (const std::string& fixed : {crossed, ball_}) {
    const bool crosses = fixed == crossed;
    const std::vector<std::string> path = {"approach", fixed,    small,    "--voxel-size", "0.25",
                                           "--axis",   "x",      "--from", "0.5",          "--to",
                                           "9",        "--step", "4"};
    std::vector<std::string> words = path;
    words.emplace_back("--json");
    const auto lines = json_lines(ist_well(words).out);
    for (const json& line : lines) EXPECT_EQ(line["self_intersecting"], crosses) << line;
    EXPECT_EQ(lines.back()["first_contact"], "inside-at-start");
    EXPECT_EQ(says(ist_well(path).out, "inside the other; a surface intersects itself"), crosses);
  }
  // Without triangles it is unknown, and so are the nearest ones.
  const std::string plain = tree_without_triangles("plain.ist");
  const json line = ask(plain, small, {"--voxel-size", "0.5"})[0];
  for (const char* key :
       {"self_intersecting", "nearest_fixed", "nearest_moving", "nearest_triangles"}) {
    EXPECT_TRUE(line[key].is_null()) << key;
  }
}

TEST_F(Answers, AWideDepthIsTold) {
  const std::string small = mesh("small.stl", box({-0.5, -0.5, 1.5}, {0.5, 0.5, 2.5}));
  const std::vector<std::string> few = {"collide", ball_,         small, "--voxel-size",
                                        "0.5",     "--max-tests", "20"};
  EXPECT_TRUE(says(ist_well(few).out, "note       depth: asked to "));
  std::vector<std::string> words = few;
  words.emplace_back("--json");
  const json wide = json_lines(ist_well(words).out).at(0);
  EXPECT_EQ(wide["depth_complete"], false);
  EXPECT_EQ(wide["depth_capped"], false);
  EXPECT_TRUE(has_note(wide, "depth: asked to "));
  const json whole = ask(ball_, small, {"--voxel-size", "0.5"})[0];
  EXPECT_EQ(whole["depth_complete"], true);
  EXPECT_EQ(whole["depth_capped"], false);
  const std::string plain = tree_without_triangles("plain.ist");
  const json none = ask(plain, small, {"--voxel-size", "0.5"})[0];
  EXPECT_TRUE(none["depth_complete"].is_null() && none["depth_capped"].is_null());
}

TEST_F(Answers, MaxTestsStopsAndSaysHowFar) {
  const auto all = ask(ball_, ball_, {"--voxel-size", "0.5", "--exact"});
  for (const char* tests : {"0", "1", "40", "1000000"}) {
    const auto lines = ask(ball_, ball_, {"--voxel-size", "0.5", "--max-tests", tests, "--exact"});
    for (std::size_t i = 0; i < 4; ++i) {
      const json& line = lines[i];
      EXPECT_LE(line["sphere_tests"], std::max(1, std::stoi(tests)));
      EXPECT_LE(line["distance_lower"], all[i]["distance_upper"]);
      EXPECT_GE(line["distance_upper"], all[i]["distance_lower"]);
      EXPECT_LE(line["depth_lower"], all[i]["depth_upper"]);
      EXPECT_GE(line["depth_upper"], all[i]["depth_lower"]);
      EXPECT_TRUE(line["touch"] == "unknown" || line["touch"] == all[i]["touch"]);
      EXPECT_EQ(line["touch"] == "unknown", has_note(line, "stopped: "));
      EXPECT_TRUE(line["triangle_pairs"].is_null() ||
                  line["triangle_pairs"] == all[i]["triangle_pairs"]);
      EXPECT_EQ(line["contacts"].is_null(), line["complete"] == false);
      if (line["complete"]) {
        EXPECT_EQ(line["leaf_pairs"], all[i]["leaf_pairs"]);
        EXPECT_EQ(line["level"], 0);
      } else {
        EXPECT_GT(line["level"], 0);
      }
    }
    EXPECT_EQ(lines[0]["complete"], std::stoi(tests) == 1000000);
    EXPECT_TRUE(lines[3]["complete"]);  // the roots are apart
    EXPECT_EQ(lines[3]["touch"], "no");
  }
  const CommandResult words = ist_well({"collide", ball_, ball_, "--poses", list_, "--voxel-size",
                                        "0.5", "--max-tests", "40", "--timing"});
  EXPECT_TRUE(says(words.out, "stopped at level"));
}

TEST_F(Answers, TouchingFailsWhereItIsAskedTo) {
  IST_SLOW();
  const auto code = [&](const std::string& shift, const std::string& body) {
    return ist({"collide", body, body, "--move", shift + ",0,0", "--fail-if-touching"}).exit_code;
  };
  const std::string plain = tree_without_triangles("plain.ist"), tree = ball_tree();
  EXPECT_EQ(code("3.9", tree), 6);
  EXPECT_EQ(code("4.1", tree), 0);
  EXPECT_EQ(code("4.1", plain), 6);  // may touch
  EXPECT_EQ(code("9", plain), 0);
  const auto why = [&](const std::string& moving, const std::string& shift) {
    return ist({"collide", ball_, moving, "--move", shift, "--fail-if-touching"}).err;
  };
  EXPECT_TRUE(says(why(ball_, "3.9,0,0"), "ist: the bodies touch\n"));
  EXPECT_TRUE(says(why(plain, "3.9,0,0"), "ist: the bodies may touch\n"));
  EXPECT_TRUE(says(why(cube(0.5), "0,0,0"), "ist: one body lies in the other\n"));
  EXPECT_EQ(
      ist({"approach", tree, tree, "--axis", "x", "--from", "9", "--to", "3", "--fail-if-touching"})
          .exit_code,
      6);
}

TEST_F(Answers, UnknownInside_Fails) {
  TriangleMesh open = box({-2, -2, -2}, {2, 2, 2});
  open.triangles.pop_back();
  const std::string small = cube(0.5);
  for (const std::string& outer : {tree_without_triangles("plain.ist"), mesh("shell.stl", open)}) {
    const auto asked = [&](const char* shift) {
      return ist(
          {"collide", outer, small, "--move", shift, "--voxel-size", "0.25", "--fail-if-touching"});
    };
    const CommandResult within = asked("0,0,0");
    EXPECT_EQ(within.exit_code, 1) << within.out;
    EXPECT_TRUE(says(within.out, "note       inside is not known"));
    EXPECT_TRUE(says(within.err,
                     "ist: the surfaces are apart; whether one body lies in the other is unknown"));
    EXPECT_EQ(asked("9,0,0").exit_code, 0);
  }
}

TEST_F(Answers, UnknownFailsWhereTouchingDoes) {
  const auto asked = [&](const char* tests) {
    return ist({"collide", ball_, ball_, "--move", "3.9,0,0", "--voxel-size", "0.5", "--max-tests",
                tests, "--fail-if-touching"});
  };
  const CommandResult unknown = asked("1");
  EXPECT_EQ(unknown.exit_code, 1) << unknown.out;
  EXPECT_TRUE(says(unknown.out, "touch      unknown"));
  EXPECT_TRUE(
      says(unknown.err, "ist: whether the bodies touch is unknown: allow more --max-tests\n"));
  EXPECT_EQ(asked("1000000").exit_code, 6);
  // A touch at another pose is certain.
  const CommandResult some = ist({"collide", ball_, ball_, "--poses", list_, "--voxel-size", "0.5",
                                  "--max-tests", "600", "--fail-if-touching", "--json"});
  const auto lines = json_lines(some.out);
  EXPECT_EQ(lines.at(0)["touch"], "unknown");
  EXPECT_EQ(lines.at(1)["touch"], "yes");
  EXPECT_EQ(some.exit_code, 6);
}

TEST_F(Answers, ContradictionsAreRefused) {
  refuses({"--max-tests", "5", "--verify"}, "contradicts");
  refuses({"--timing", "--json"}, "contradicts");
  refuses({"--max-tests", "-5"}, "decimal digits");
  refuses({"--max-tests", "010"}, "decimal digits");
  refuses({"--max-tests", "1.5"}, "--max-tests");
  for (const char* flag : {"--distance", "--depth"}) {
    for (const char* value : {"-1", "nan", "inf", "x", "1e400"}) refuses({flag, value}, flag);
  }
  refuses({"--max-tests", "1", "--engine", "reference"}, "--engine simd");
}

// A year on, a line can be understood: the first one says of what it is.
TEST_F(Answers, TheFirstLineSaysOfWhat) {
  const std::string out =
      ist_well({"collide", ball_, ball_tree(), "--voxel-size", "0.25", "--json"}).out;
  const json header = json::parse(out.substr(0, out.find('\n')));
  EXPECT_TRUE(header["ist"].is_string() && header["commit"].is_string());
  EXPECT_EQ(header["subcommand"], "collide");
  EXPECT_EQ(header["fixed"]["file"], "ball.stl");  // no path
  EXPECT_EQ(header["fixed"]["hash"].get<std::string>().size(), 16u);
  EXPECT_NE(header["fixed"]["hash"], header["moving"]["hash"]);
  EXPECT_EQ(header["voxel_size"], (json{0.25, 0.5}));
}

TEST_F(Answers, EverySubcommandBeginsSo) {
  IST_SLOW();
  const std::string tree = ball_tree();
  const std::vector<std::vector<std::string>> asked = {
      {"demo", "--voxel-size", "8"},
      {"build", ball_, "-o", path("b.ist"), "--voxel-size", "1"},
      {"info", ball_},
      {"info", tree},
      {"export", tree, "--what", "voxels", "--level", "0", "-o", path("v.vtp")},
      {"approach", tree, tree, "--axis", "x", "--from", "9", "--to", "8"},
      {"occlusion", tree, tree, "--move", "3.9,0,0"},
      {"table", "--format", "c", "-o", path("t.h")}};
  for (std::vector<std::string> arguments : asked) {
    arguments.emplace_back("--json");
    const std::string out = ist_well(arguments).out;
    const json header = json::parse(out.substr(0, out.find('\n')));
    EXPECT_TRUE(header.contains("ist") && header.contains("commit")) << arguments[0];
    EXPECT_EQ(header["subcommand"], arguments[0]);
    EXPECT_FALSE(says(header.dump(), dir_.path().string())) << "no paths";
    EXPECT_GE(json_lines(out).size(), 1u);
  }
}

// People are told without voxels, where nothing of them is asked.
TEST_F(Answers, VoxelsAreMadeWhereTheyAreAskedFor) {
  IST_SLOW();
  const CommandResult people = ist_well({"collide", ball_, ball_, "--move", "3.9,0,0"});
  EXPECT_EQ(people.err.find("voxel"), std::string::npos) << people.err;
  EXPECT_TRUE(says(people.out, "touch      yes"));
  EXPECT_EQ(without_notes(ist_well({"collide", ball_, ball_, "--move", "3.9,0,0", "--json"}).err),
            "");
  for (const char* flag : {"--timing", "--verify"}) {
    EXPECT_TRUE(says(ist_well({"collide", ball_, ball_, "--move", "3.9,0,0", flag}).err,
                     "voxel size 0.008"));
  }
}

}  // namespace
}  // namespace ist::test
