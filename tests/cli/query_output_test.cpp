#include <cmath>
#include <csignal>
#include <map>
#include <sstream>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "simd/dispatch.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class QueryOutput : public CliTest {
 protected:
  // A contact point of two balls of radius 2, of voxels of 0.5 and 0.4, the second moved along x.
  static void check_point(const json& point, double shift) {
    EXPECT_EQ(point.size(), 6u) << point;
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

  // Every key of a line, and no other, with its type, for balls that are closed.
  static void check_line(const json& line) {
    using Type = json::value_t;
    const bool touches = line["touch"] == "yes", deep = line["depth_lower"] > 0;
    std::map<std::string, Type> keys = {
        {"index", Type::number_unsigned},
        {"pose", Type::array},
        {"rotation_error", Type::number_float},
        {"engine", Type::string},
        {"spheres", Type::string},
        {"target", Type::string},
        {"workers", Type::number_unsigned},
        {"voxel_size", Type::array},
        {"resolution", Type::number_float},
        {"complete", Type::boolean},
        {"truncated", Type::boolean},
        {"level", Type::number_unsigned},
        {"touch", Type::string},
        {"inside", Type::string},
        {"leaf_pairs", Type::number_unsigned},
        {"triangle_pairs", Type::null},
        {"distance_lower", Type::number_float},
        {"distance_upper", Type::number_float},
        {"distance_narrowest", Type::number_float},
        {"nearest_fixed", Type::array},
        {"nearest_moving", Type::array},
        {"nearest_triangles", Type::array},
        {"depth_lower", Type::number_float},
        {"depth_upper", Type::number_float},
        {"depth_complete", Type::boolean},
        {"depth_capped", Type::boolean},
        {"self_intersecting", Type::boolean},
        {"depth_at_vertices", Type::number_float},
        {"depth_point", deep ? Type::array : Type::null},
        {"escape", Type::null},
        {"contacts", Type::number_unsigned},
        {"contact_depth", line["contacts"] > 0 ? Type::number_float : Type::null},
        {"area", Type::number_float},
        {"sphere_tests", Type::number_unsigned},
        {"microseconds_min", Type::number_float},
        {"microseconds_median", Type::number_float},
        {"notes", Type::array}};
    if (line.contains("displacement")) keys["displacement"] = Type::number_float;
    EXPECT_EQ(line.size(), keys.size()) << line;
    for (const auto& [key, type] : keys) {
      ASSERT_TRUE(line.contains(key)) << key;
      EXPECT_EQ(line[key].type(), type) << key << " in " << line;
    }
    EXPECT_EQ(line["pose"].size(), 16u);
    ASSERT_EQ(line["voxel_size"].size(), 2u);
    EXPECT_TRUE(line["voxel_size"][0].is_number() && line["voxel_size"][1].is_number());
    EXPECT_TRUE(!touches || line["leaf_pairs"] > 0);
    EXPECT_EQ(touches, line["distance_upper"] == 0);
    ASSERT_EQ(line["nearest_fixed"].size(), 3u);
    ASSERT_EQ(line["nearest_moving"].size(), 3u);
    ASSERT_EQ(line["nearest_triangles"].size(), 2u);
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double way =
          line["nearest_moving"][i].get<double>() - line["nearest_fixed"][i].get<double>();
      square += way * way;
    }
    EXPECT_LE(std::sqrt(square), line["distance_upper"].get<double>() + 1e-9);
    EXPECT_GE(std::sqrt(square), line["distance_lower"].get<double>() - 1e-9);
    EXPECT_LE(line["depth_lower"], line["depth_upper"]);
    EXPECT_TRUE(line["area"] > 0 || line["depth_at_vertices"] == 0) << line;
    EXPECT_EQ(line["complete"], true);
    EXPECT_EQ(line["truncated"], false);
    EXPECT_EQ(line["level"], 0);
    EXPECT_EQ(line["target"], line["engine"] == "simd" ? select_kernels({}).target : "scalar");
    EXPECT_EQ(line["workers"], 1);
    EXPECT_GE(line["sphere_tests"], 1);
    EXPECT_GT(line["microseconds_min"], 0);
    EXPECT_LE(line["microseconds_min"], line["microseconds_median"]);
    EXPECT_TRUE(line["notes"].empty()) << line;
  }
};

TEST_F(QueryOutput, ALineForEachPoseInOrder) {
  const std::string mesh = ball();
  const CommandResult result = ist_well({"collide", mesh, mesh, "--voxel-size", "0.05", "--poses",
                                         poses({0, 100, 3.5, 0}), "--json"});
  EXPECT_EQ(without_notes(result.err), "");
  const auto lines = json_lines(result.out);
  ASSERT_EQ(lines.size(), 4u);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    check_line(lines[i]);
    EXPECT_EQ(lines[i]["index"], i);
    EXPECT_EQ(lines[i]["engine"], "simd");
    EXPECT_EQ(lines[i]["spheres"], to_string(BuildOptions{}.spheres));
    EXPECT_EQ(lines[i]["voxel_size"], (json{0.05, 0.05}));
    EXPECT_EQ(lines[i]["touch"], i != 1 ? "yes" : "no");
  }
  EXPECT_EQ(lines[1]["sphere_tests"], 1);
  EXPECT_EQ(lines[0]["leaf_pairs"], lines[3]["leaf_pairs"]);
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
  IST_SLOW();
  const std::string tree = ball_tree("ball.ist", "slab"), list = poses({0, 3.9});
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string spheres(to_string(policy));
    const CommandResult as_json =
        ist_well({"collide", tree, tree, "--poses", list, "--spheres", spheres, "--json"});
    for (const json& line : json_lines(as_json.out)) EXPECT_EQ(line["spheres"], spheres);
    const CommandResult plain =
        ist_well({"collide", tree, tree, "--poses", list, "--spheres", spheres});
    EXPECT_TRUE(says(plain.out, "touch "));
    EXPECT_EQ(std::count(plain.out.begin(), plain.out.end(), '\n'), 3);
    const CommandResult timed =
        ist_well({"collide", tree, tree, "--poses", list, "--spheres", spheres, "--timing"});
    EXPECT_TRUE(says(timed.out, "spheres " + spheres));
    EXPECT_TRUE(says(timed.out, "leaf pairs"));
    EXPECT_EQ(std::count(timed.out.begin(), timed.out.end(), '\n'), 3 + 5);
    // A value under each heading.
    const std::string table =
        timed.out.substr(timed.out.find("\nindex", timed.out.find("spheres")));
    std::istringstream rows(table);
    std::string heading, row;
    std::getline(rows, heading);
    std::getline(rows, heading);
    std::getline(rows, row);
    EXPECT_EQ(row.size(), heading.size() - 2) << "µ takes two bytes, twice; Hz ends both\n"
                                              << table;
  }
}

TEST_F(QueryOutput, ApproachGoesAlongItsPath) {
  IST_SLOW();
  std::string tree;
  const auto approach = [&](const std::string& from, const std::string& to,
                            const std::string& step) {
    const CommandResult result = ist_well({"approach", tree, tree, "--axis", "y", "--from", from,
                                           "--to", to, "--step", step, "--json"});
    auto lines = json_lines(result.out);
    EXPECT_TRUE(lines.back().contains("first_contact"));
    lines.pop_back();
    return lines;
  };
  for (const char* spheres : {"tight", "slab"}) {
    tree = ball_tree("ball.ist", spheres);
    const auto down = approach("6", "0", "0.5");
    ASSERT_EQ(down.size(), 13u);
    for (std::size_t i = 0; i < down.size(); ++i) {
      check_line(down[i]);
      EXPECT_EQ(down[i]["index"], i);
      EXPECT_EQ(down[i]["spheres"], spheres);
      // Balls of radius 2: they touch at 4, and are free where farther apart than the resolution.
      const double distance = 6 - 0.5 * static_cast<double>(i) - 4;
      EXPECT_EQ(down[i]["displacement"], 6 - 0.5 * static_cast<double>(i));
      EXPECT_TRUE(down[i]["touch"] == "yes" || distance > -0.05) << i;
      EXPECT_TRUE(down[i]["touch"] == "no" || distance <= 0) << i;
    }
    const auto up = approach("0", "6", "0.5");
    ASSERT_EQ(up.size(), 13u);
    for (std::size_t i = 0; i < up.size(); ++i) {
      EXPECT_EQ(up[i]["leaf_pairs"], down[12 - i]["leaf_pairs"]);
    }
  }
  EXPECT_EQ(approach("1", "1", "0.5").size(), 1u);
  EXPECT_EQ(approach("0", "0.3", "0.1").size(), 4u);  // though 0.3 / 0.1 is less than 3 in double
  EXPECT_EQ(approach("0", "1", "0.3").size(), 4u);
  EXPECT_EQ(approach("0", "1", "7").size(), 1u);
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
      if (leaf_pair["kind"] == "contact") {
        points[index].push_back(leaf_pair);
        continue;
      }
      EXPECT_EQ(leaf_pair["kind"], "leaf pair");
      EXPECT_EQ(leaf_pair.size(), 4u);
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
      EXPECT_EQ(lines[2 * i]["leaf_pairs"], count[i]);
      EXPECT_EQ(lines[2 * i]["contacts"], points[i].size());
      EXPECT_EQ(points[i].empty(), count[i] == 0);
      for (const json& point : points[i]) check_point(point, i == 0 ? 3.5 : 1);
    }
    EXPECT_GT(count[0], 0u);
  }
}

// The same contacts in every format.
TEST_F(QueryOutput, ContactsAreWrittenByTheFilesEnding) {
  const std::string tree = ball_tree(), list = poses({3.5, 1});
  const auto ask = [&](const std::string& name) {
    ist_well({"collide", tree, tree, "--poses", list, "--contacts", path(name)});
    return file_content(path(name));
  };
  const auto lines = json_lines(ask("c.jsonl"));
  ASSERT_GT(lines.size(), 100u);
  std::istringstream rows(ask("c.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row,
            "index,kind,x,y,z,radius,moving_x,moving_y,moving_z,normal_x,normal_y,normal_z,depth,"
            "weight");
  for (const json& line : lines) {
    const bool contact = line["kind"] == "contact";
    ASSERT_TRUE(std::getline(rows, row));
    std::vector<std::string> fields;
    std::istringstream stream(row);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    fields.resize(14);  // the last ones may be empty
    EXPECT_EQ(fields[0], std::to_string(line["index"].get<int>()));
    EXPECT_EQ(fields[1], line["kind"]);
    const json& at = line[contact ? "position" : "fixed_centre"];
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(std::stod(fields[2 + i]), at[i]);
      EXPECT_EQ(fields[6 + i].empty(), contact);
      EXPECT_EQ(fields[9 + i].empty(), !contact);
    }
    EXPECT_GT(std::stod(fields[5]), 0);
    if (!contact) continue;
    EXPECT_EQ(std::stod(fields[12]), line["depth"]);
    EXPECT_EQ(std::stod(fields[13]), line["weight"]);
  }
  EXPECT_FALSE(std::getline(rows, row));
  const std::string points = std::to_string(lines.size());
  EXPECT_TRUE(says(ask("c.ply").substr(0, 400), "element vertex " + points + "\n"));
  EXPECT_TRUE(says(ask("c.vtp").substr(0, 400), "NumberOfPoints=\"" + points + "\""));
  const CommandResult refused = ist({"collide", tree, tree, "--contacts", path("c.stl")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(says(refused.err, ".jsonl"));
  EXPECT_FALSE(exists("c.stl"));
}

// Forces are not made of a part: an answer that was stopped has no points.
TEST_F(QueryOutput, ContactPointsAreThoseOfAWholeAnswer) {
  const std::string tree = ball_tree("ball.ist", "slab"), file = path("contacts.jsonl");
  const auto points = [&](const std::string& tests) {
    ist_well(
        {"collide", tree, tree, "--poses", poses({3.5}), "--contacts", file, "--max-tests", tests});
    std::size_t count = 0;
    for (const json& line : json_lines(file_content(file))) count += line["kind"] == "contact";
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
  if (!std::filesystem::exists("/dev/full")) IST_SKIP("/dev/full is not there");
  const std::string tree = ball_tree();
  std::filesystem::create_symlink("/dev/full", path("full.csv"));
  const CommandResult result =
      ist({"collide", tree, tree, "--poses", poses({0}), "--contacts", path("full.csv")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "full.csv: cannot write"));
  const CommandResult lost =
      run_command("/bin/sh", {"-c", "exec \"$0\" info \"$1\" > /dev/full", IST_COMMAND, tree});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_TRUE(says(lost.err, "cannot write to stdout"));
  for (const char* words : {"--help", "--version", "help collide"}) {
    const CommandResult taught = run_command(
        "/bin/sh", {"-c", std::string("exec \"$0\" ") + words + " > /dev/full", IST_COMMAND});
    EXPECT_EQ(taught.exit_code, 1) << words;
    EXPECT_TRUE(says(taught.err, "cannot write to stdout"));
  }
}

// `head` has gone before the command says anything: a shell writes to the pipe until that fails.
TEST_F(QueryOutput, APipeWithoutAReaderEndsItInSilence) {
  IST_SLOW();
  const std::string tree = ball_tree("ball.ist", "table", {"--voxel-size", "0.05"});
  const std::string other = smaller_fine_tree();
  const std::string rows = path("rows.csv");
  const std::size_t entries = dir_.entries();
  const auto piped = [&](const char* before, const std::vector<std::string>& words) {
    std::vector<std::string> arguments{
        "-c",
        std::string("{ (trap '' PIPE; while /bin/echo; do :; done) 2>&-; ") + before +
            " \"$0\" \"$@\"; echo $? >&3; } 3>&2 | true",
        IST_COMMAND};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return run_command("/bin/sh", arguments).err;
  };
  const std::string died = std::to_string(128 + SIGPIPE) + "\n";
  EXPECT_EQ(piped("", {"collide", tree, other, "--contacts", rows}), died);
  EXPECT_EQ(piped("", {"collide", tree, other, "--json"}), died);
  EXPECT_EQ(piped("", {"table", "--format", "json"}), died);
  EXPECT_EQ(piped("", {"table", "--vectors", "100000", "-o", "/dev/stdout"}), died);
  EXPECT_EQ(piped("", {"run", IST_SCENES "/press.toml", "--unpaced", "--record", "/dev/stdout"}),
            died);
  EXPECT_EQ(dir_.entries(), entries + 1) << "the rows are whole, and nothing else is left";
  const std::string ignored =
      piped("trap '' PIPE;", {"collide", tree, other, "--contacts", path("more.csv")});
  EXPECT_TRUE(says(ignored, "cannot write")) << ignored;
  EXPECT_TRUE(ignored.ends_with("1\n")) << ignored;
}

}  // namespace
}  // namespace ist::test
