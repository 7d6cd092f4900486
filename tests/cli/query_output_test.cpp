#include <cmath>
#include <map>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "simd/dispatch.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class QueryOutput : public CliTest {
 protected:
  // A contact point of two balls of radius 2, of voxels of 0.5 and 0.4, the second moved along x.
  static void check_point(const json& point, double shift) {
    EXPECT_EQ(point.size(), 5u) << point;
    const auto p = point["position"].get<std::vector<double>>(),
               n = point["normal"].get<std::vector<double>>();
    ASSERT_TRUE(p.size() == 3 && n.size() == 3);
    EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-12);
    EXPECT_GT(point["weight"], 0);
    EXPECT_GE(point["depth"], -0.9);
    EXPECT_LE(point["depth"], 0.45);
    // Where both surfaces are, or between such places that are joined.
    EXPECT_NEAR(std::hypot(p[0], p[1], p[2]), 2, 1);
    EXPECT_NEAR(std::hypot(p[0] - shift, p[1], p[2]), 2, 1);
    // From the first ball to the second: along x, where it is between them.
    EXPECT_GT(n[0], 0);
  }

  // Every key of a line, and no other, with its type.
  static void check_line(const json& line) {
    using Type = json::value_t;
    const std::map<std::string, Type> keys = {{"index", Type::number_unsigned},
                                              {"engine", Type::string},
                                              {"spheres", Type::string},
                                              {"target", Type::string},
                                              {"workers", Type::number_unsigned},
                                              {"voxel_size", Type::array},
                                              {"resolution", Type::number_float},
                                              {"complete", Type::boolean},
                                              {"truncated", Type::boolean},
                                              {"level", Type::number_unsigned},
                                              {"colliding", Type::boolean},
                                              {"inside", Type::null},
                                              {"contacts", Type::number_unsigned},
                                              {"gap_lower", Type::null},
                                              {"gap_upper", Type::null},
                                              {"sphere_tests", Type::number_unsigned},
                                              {"microseconds_min", Type::number_float},
                                              {"microseconds_median", Type::number_float}};
    EXPECT_EQ(line.size(), keys.size()) << line;
    for (const auto& [key, type] : keys) {
      ASSERT_TRUE(line.contains(key)) << key;
      EXPECT_EQ(line[key].type(), type) << key << " in " << line;
    }
    ASSERT_EQ(line["voxel_size"].size(), 2u);
    EXPECT_TRUE(line["voxel_size"][0].is_number() && line["voxel_size"][1].is_number());
    EXPECT_EQ(line["colliding"], line["contacts"] > 0);
    EXPECT_EQ(line["complete"], true);
    EXPECT_EQ(line["truncated"], false);
    EXPECT_EQ(line["level"], 0);
    EXPECT_EQ(line["target"], line["engine"] == "simd" ? select_kernels({}).target : "scalar");
    EXPECT_EQ(line["workers"], 1);
    EXPECT_GE(line["sphere_tests"], 1);
    EXPECT_GT(line["microseconds_min"], 0);
    EXPECT_LE(line["microseconds_min"], line["microseconds_median"]);
  }
};

TEST_F(QueryOutput, ALineForEachPoseInOrder) {
  const std::string mesh = ball();
  const CommandResult result = ist_well(
      {"collide", mesh, mesh, "--voxel-size", "0.5", "--poses", poses({0, 100, 3.5, 0}), "--json"});
  EXPECT_EQ(result.err, "");
  const auto lines = json_lines(result.out);
  ASSERT_EQ(lines.size(), 4u);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    check_line(lines[i]);
    EXPECT_EQ(lines[i]["index"], i);
    EXPECT_EQ(lines[i]["engine"], "simd");
    EXPECT_EQ(lines[i]["spheres"], to_string(BuildOptions{}.spheres));
    EXPECT_EQ(lines[i]["voxel_size"], (json{0.5, 0.5}));
    EXPECT_EQ(lines[i]["colliding"], i != 1);
  }
  EXPECT_EQ(lines[1]["sphere_tests"], 1);
  EXPECT_EQ(lines[0]["contacts"], lines[3]["contacts"]);
}

TEST_F(QueryOutput, LinesGoByIndexThenByEngineHoweverOftenTheyAreAsked) {
  const std::string mesh = ball();
  for (const auto& [first, second] : {std::pair("reference", "simd"), {"simd", "reference"}}) {
    const CommandResult result = ist_well({"collide", mesh, mesh, "--voxel-size", "0.5", "--poses",
                                           poses({0, 1, 2}), "--json", "--spheres", "table",
                                           "--repeat", "5", "--engine", first, "--engine", second});
    const auto lines = json_lines(result.out);
    ASSERT_EQ(lines.size(), 6u);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      check_line(lines[i]);
      EXPECT_EQ(lines[i]["index"], i / 2);
      EXPECT_EQ(lines[i]["engine"], i % 2 == 0 ? first : second);
    }
  }
}

TEST_F(QueryOutput, WarningsStayOutOfTheData) {
  const std::string open = mesh("open.stl", open_strip(2));
  const CommandResult result =
      ist_well({"collide", open, open, "--voxel-size", "0.5", "--poses", poses({0}), "--json"});
  EXPECT_TRUE(says(result.err, "warning: "));
  EXPECT_EQ(json_lines(result.out).size(), 1u);
}

TEST_F(QueryOutput, EveryPolicyAndATableForPeople) {
  const std::string tree = ball_tree("ball.ist", "slab"), list = poses({0, 3.9});
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string spheres(to_string(policy));
    const CommandResult as_json =
        ist_well({"collide", tree, tree, "--poses", list, "--spheres", spheres, "--json"});
    for (const json& line : json_lines(as_json.out)) EXPECT_EQ(line["spheres"], spheres);
    const CommandResult plain =
        ist_well({"collide", tree, tree, "--poses", list, "--spheres", spheres});
    EXPECT_TRUE(says(plain.out, "spheres " + spheres));
    EXPECT_TRUE(says(plain.out, "contacts"));
    EXPECT_EQ(std::count(plain.out.begin(), plain.out.end(), '\n'), 4);
  }
}

TEST_F(QueryOutput, CloseGoesAlongItsPath) {
  std::string tree;
  const auto close = [&](const std::string& from, const std::string& to, const std::string& step) {
    const CommandResult result = ist_well(
        {"close", tree, tree, "--axis", "y", "--from", from, "--to", to, "--step", step, "--json"});
    return json_lines(result.out);
  };
  for (const char* spheres : {"tight", "slab"}) {
    tree = ball_tree("ball.ist", spheres);
    const auto down = close("6", "0", "0.5");
    ASSERT_EQ(down.size(), 13u);
    for (std::size_t i = 0; i < down.size(); ++i) {
      check_line(down[i]);
      EXPECT_EQ(down[i]["index"], i);
      EXPECT_EQ(down[i]["spheres"], spheres);
      // Balls of radius 2: they touch at 4, and are free where farther apart than the resolution.
      const double distance = 6 - 0.5 * static_cast<double>(i) - 4;
      EXPECT_TRUE(down[i]["colliding"] == true || distance > -0.05 || distance < -3.5) << i;
      EXPECT_TRUE(down[i]["colliding"] == false || distance <= down[i]["resolution"]) << i;
    }
    const auto up = close("0", "6", "0.5");
    ASSERT_EQ(up.size(), 13u);
    for (std::size_t i = 0; i < up.size(); ++i) {
      EXPECT_EQ(up[i]["contacts"], down[12 - i]["contacts"]);
    }
  }
  EXPECT_EQ(close("1", "1", "0.5").size(), 1u);
  EXPECT_EQ(close("0", "0.3", "0.1").size(), 4u);  // though 0.3 / 0.1 is less than 3 in double
  EXPECT_EQ(close("0", "1", "0.3").size(), 4u);
  EXPECT_EQ(close("0", "1", "7").size(), 1u);
}

TEST_F(QueryOutput, ContactsAreWrittenOneByOne) {
  const std::string tree = ball_tree("ball.ist", "slab");
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string spheres(to_string(policy));
    const CommandResult result =
        ist_well({"collide", tree, ball(), "--voxel-size", "0.4", "--poses", poses({3.5, 100, 1}),
                  "--contacts", path("contacts.jsonl"), "--json", "--repeat", "3", "--spheres",
                  spheres, "--engine", "reference", "--engine", "simd"});
    const auto lines = json_lines(result.out);
    std::map<std::size_t, std::size_t> count;
    std::map<std::size_t, std::vector<json>> points;
    std::size_t last = 0;
    for (const json& leaf_pair : json_lines(file_content(path("contacts.jsonl")))) {
      const auto index = leaf_pair["index"].get<std::size_t>();
      EXPECT_GE(index, last);
      last = index;
      if (leaf_pair.contains("position")) {
        points[index].push_back(leaf_pair);
        continue;
      }
      EXPECT_EQ(leaf_pair.size(), 3u);
      EXPECT_EQ(points.count(index), 0u);  // they come after all leaf pairs of a pose
      ++count[index];
      const auto fixed = leaf_pair["fixed_centre"].get<std::vector<double>>();
      const auto moving = leaf_pair["moving_centre"].get<std::vector<double>>();
      ASSERT_TRUE(fixed.size() == 3 && moving.size() == 3);
      double square = 0;
      for (std::size_t i = 0; i < 3; ++i) square += (fixed[i] - moving[i]) * (fixed[i] - moving[i]);
      EXPECT_LE(std::sqrt(square), lines[2 * index]["resolution"]);
      // In fixed coordinates, both near their balls.
      const double shift = index == 0 ? 3.5 : 1;
      EXPECT_NEAR(std::hypot(fixed[0], fixed[1], fixed[2]), 2, 0.5);
      EXPECT_NEAR(std::hypot(moving[0] - shift, moving[1], moving[2]), 2, 0.5);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(lines[2 * i]["contacts"], count[i]);
      EXPECT_EQ(points[i].empty(), count[i] == 0);
      for (const json& point : points[i]) check_point(point, i == 0 ? 3.5 : 1);
    }
    EXPECT_GT(count[0], 0u);
  }
}

// Forces are not made of a part: an answer that was stopped has no points.
TEST_F(QueryOutput, ContactPointsAreThoseOfAWholeAnswer) {
  const std::string tree = ball_tree("ball.ist", "slab"), file = path("contacts.jsonl");
  const auto points = [&](const std::string& tests) {
    ist_well(
        {"collide", tree, tree, "--poses", poses({3.5}), "--contacts", file, "--max-tests", tests});
    std::size_t count = 0;
    for (const json& line : json_lines(file_content(file))) count += line.contains("position");
    return count;
  };
  EXPECT_GT(points("1000000"), 1u);
  EXPECT_LE(points("1000000"), 32u);
  EXPECT_EQ(points("100"), 0u);
}

TEST_F(QueryOutput, ContactsAreThereWholeOrNotAtAll) {
  const std::string tree = ball_tree();
  const std::string nowhere = path("none/contacts.jsonl");
  const CommandResult failed =
      ist({"collide", tree, tree, "--poses", poses({0}), "--contacts", nowhere, "--json"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.out, "");
  EXPECT_TRUE(says(failed.err, nowhere + ": "));
  EXPECT_FALSE(exists("none"));

  const std::string old = write("contacts.jsonl", "old\n");
  const CommandResult refused =
      ist({"collide", tree, tree, "--poses", write("bad.json", "[]"), "--contacts", old});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(file_content(old), "old\n");
  ist_well({"collide", tree, tree, "--poses", poses({100}), "--contacts", old});
  EXPECT_EQ(file_content(old), "");
}

TEST_F(QueryOutput, AFullDiskIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "/dev/full is not there";
  const std::string tree = ball_tree();
  const CommandResult result =
      ist({"collide", tree, tree, "--poses", poses({0}), "--contacts", "/dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "/dev/full: cannot write"));
  const CommandResult lost =
      run_command("/bin/sh", {"-c", "exec \"$0\" info \"$1\" > /dev/full", IST_COMMAND, tree});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_TRUE(says(lost.err, "cannot write to stdout"));
}

}  // namespace
}  // namespace ist::test
