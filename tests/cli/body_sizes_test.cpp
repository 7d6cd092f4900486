// The two bodies of a query: whether their units and sizes fit each other, and their voxels them.

#include <utility>

#include "cli/cli_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class BodySizes : public CliTest {
 protected:
  [[nodiscard]] std::string tree(const std::string& name, const std::string& unit) const {
    std::vector<std::string> arguments{"build",    needle("needle.stl", 4), "-o",
                                       path(name), "--voxel-size",          "0.02"};
    if (!unit.empty()) arguments.insert(arguments.end(), {"--unit", unit});
    ist_well(arguments);
    return path(name);
  }
  [[nodiscard]] CommandResult collide(const std::string& fixed, const std::string& moving,
                                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"collide", fixed, moving, "--poses", poses({0}), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ist(arguments);
  }
};

TEST_F(BodySizes, QueriesChooseVoxelsOfTheSmallerBody) {
  IST_SLOW();
  const std::string large = needle("large.stl", 4), other = needle("other.stl", 4.1),
                    small = needle("small.stl", 1);
  const std::string built = tree("built.ist", "");
  const std::string said =
      ": 1/500 of the smaller body's largest extent; --voxel-size names another\n";
  const auto asks = [&](const std::string& fixed, const std::string& moving,
                        const std::string& size, const json& sizes) {
    const CommandResult result = collide(fixed, moving, {"--engine", "simd"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(without_notes(result.err), "voxel size " + size + said);
    EXPECT_EQ(json_lines(result.out).at(0)["voxel_size"], sizes);
  };
  asks(large, small, "0.002", {0.002, 0.002});
  asks(small, large, "0.002", {0.002, 0.002});
  asks(large, other, "0.008", {0.008, 0.008});
  asks(built, small, "0.002", {0.02, 0.002});
  asks(large, built, "0.008", {0.008, 0.02});
  EXPECT_EQ(collide(built, built).err,
            "note: " + built + " and " + built + " hold one mesh: it is compared with itself\n");
}

TEST_F(BodySizes, OfJsonAloneHaveNoVoxels) {
  const std::string mesh = needle("needle.stl", 4), built = tree("built.ist", "");
  for (const auto& [fixed, moving] : {std::pair(mesh, mesh), {built, mesh}, {mesh, built}}) {
    const CommandResult result = collide(fixed, moving);
    EXPECT_EQ(without_notes(result.err), "");
    const json line = json_lines(result.out).at(0);
    for (const char* key : {"engine", "spheres", "target", "workers", "resolution", "complete",
                            "truncated", "level", "leaf_pairs", "sphere_tests", "contacts",
                            "contact_depth", "microseconds_min", "microseconds_median"}) {
      ASSERT_TRUE(line.contains(key)) << key;
      EXPECT_TRUE(line[key].is_null()) << key;
    }
    EXPECT_EQ(line["voxel_size"][0].is_null(), fixed == mesh);
    EXPECT_EQ(line["voxel_size"][1].is_null(), moving == mesh);
    EXPECT_EQ(line["touch"], "yes");
    EXPECT_EQ(line["distance_upper"], 0);
    EXPECT_FALSE(line["area"].is_null());
  }
  const json asked = json_lines(collide(mesh, mesh, {"--voxel-size", "0.1"}).out).at(0);
  EXPECT_EQ(asked["voxel_size"], json({0.1, 0.1}));
  EXPECT_GT(asked["leaf_pairs"], 0);
  EXPECT_GT(json_lines(collide(built, built).out).at(0)["leaf_pairs"], 0);
}

TEST_F(BodySizes, OfTreesWithoutVoxelsAreNotAskedFor) {
  const std::string mesh = needle("needle.stl", 4), alone = path("alone.ist"),
                    built = tree("built.ist", "");
  ist_well({"build", mesh, "-o", alone});
  const json wanted = json_lines(collide(mesh, mesh).out).at(0);
  for (const auto& [fixed, moving] :
       {std::pair(alone, alone), {alone, mesh}, {built, alone}, {alone, built}}) {
    const CommandResult result = collide(fixed, moving);
    EXPECT_EQ(without_notes(result.err), "");
    const json line = json_lines(result.out).at(0);
    EXPECT_EQ(line.size(), wanted.size());
    for (const char* key : {"touch", "inside", "distance_upper", "leaf_pairs", "engine", "contacts",
                            "microseconds_min"}) {
      EXPECT_EQ(line[key], wanted[key]) << key;
    }
    EXPECT_EQ(line["voxel_size"][0].is_null(), fixed != built);
    EXPECT_EQ(line["voxel_size"][1].is_null(), moving != built);
    EXPECT_EQ(json_lines(collide(fixed, moving, {"--max-tests", "1000000"}).out).at(0)["touch"],
              "yes");
    const json path_of = json_lines(ist_well({"approach", fixed, moving, "--axis", "y", "--from",
                                              "-1", "--to", "0", "--step", "1", "--json"})
                                        .out)
                             .back();
    EXPECT_EQ(path_of["first_contact"], "contact");
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--contacts", path("out.csv")},
          {"--engine", "simd"},
          {"--verify"},
          {"--timing"},
          {"--workers", "2"},
          {"--spheres", "slab"}}) {
      const CommandResult refused = more[0] == "--timing"  // contradicts --json
                                        ? ist({"collide", fixed, moving, more[0]})
                                        : collide(fixed, moving, more);
      EXPECT_EQ(refused.exit_code, 2) << more[0];
      EXPECT_TRUE(says(refused.err, "the tree holds no voxels, and " + more[0] +
                                        " needs them: build it again by ist build with "
                                        "--voxel-size"))
          << refused.err;
    }
  }
}

TEST_F(BodySizes, MeshesKeepTheirTrianglesForAQuery) {
  const std::string of = needle("needle.stl", 4);
  EXPECT_GT(json_lines(collide(of, of, {"--exact"}).out).at(0)["triangle_pairs"], 0);
}

TEST_F(BodySizes, TreesOfDifferentUnitsAreRefused) {
  const std::string mm = tree("mm.ist", "mm"), inch = tree("inch.ist", "inch"),
                    plain = tree("plain.ist", ""), mesh = path("needle.stl");
  const auto refused = [&](const std::string& fixed, const std::string& moving,
                           const std::string& why) {
    const CommandResult result = collide(fixed, moving);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, why));
    EXPECT_TRUE(says(result.err, "name the tree's mesh, and its unit by --unit-moving"));
  };
  refused(mm, inch, inch + ": the tree is in inch, and " + mm + " in mm");
  refused(inch, mm, mm + ": the tree is in mm, and " + inch + " in inch");
  for (const auto& [fixed, moving] : {std::pair(mm, mm), {mm, plain}, {plain, inch}, {mm, mesh}}) {
    EXPECT_EQ(collide(fixed, moving).exit_code, 0) << fixed << " " << moving;
  }
}

// One mesh in two units: converted, its numbers are the same up to the rounding of floats.
TEST_F(BodySizes, AMeshInAnotherUnitIsConvertedIfBothAreTold) {
  TriangleMesh in_metres = box({-2, -2, -2}, {2, 2, 2}), in_inches = in_metres;
  for (Eigen::Vector3d& vertex : in_metres.vertices) vertex *= 1e-3;
  for (Eigen::Vector3d& vertex : in_inches.vertices) vertex /= 25.4;
  const std::string mm = mesh("mm.stl", box({-2, -2, -2}, {2, 2, 2})), m = mesh("m.stl", in_metres),
                    inch = mesh("inch.stl", in_inches);
  const auto asked = [&](const std::string& fixed, const std::string& moving,
                         const std::vector<std::string>& units) {
    std::vector<std::string> arguments{"collide", fixed,    moving,       "--move",
                                       "4.5,0,0", "--json", "--distance", "1e-9"};
    if (fixed == m) arguments[4] = "0.0045,0,0";
    arguments.insert(arguments.end(), units.begin(), units.end());
    const CommandResult result = ist_well(arguments);
    EXPECT_TRUE(says(result.err, "was converted from")) << result.err;
    return json_lines(result.out).at(0)["distance_lower"].get<double>();
  };
  EXPECT_NEAR(asked(mm, m, {"--unit", "mm", "--unit-moving", "M"}), 0.5, 1e-5);
  EXPECT_NEAR(asked(mm, inch, {"--unit", "mm", "--unit-moving", "inch"}), 0.5, 1e-5);
  EXPECT_NEAR(asked(m, mm, {"--unit", "m", "--unit-moving", "mm"}), 0.5e-3, 1e-8);
  ist_well({"build", mm, "-o", path("mm.ist"), "--voxel-size", "0.5", "--unit", "mm"});
  EXPECT_NEAR(asked(path("mm.ist"), m, {"--unit-moving", "m"}), 0.5, 1e-5);
  const CommandResult unknown = ist({"collide", mm, m, "--unit-moving", "m"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(says(unknown.err, "--unit-moving: the unit of " + mm + " is not known: give --unit"));
  ist_well({"build", m, "-o", path("m.ist"), "--voxel-size", "0.5"});
  const CommandResult tree = ist({"collide", mm, path("m.ist"), "--unit-moving", "m"});
  EXPECT_EQ(tree.exit_code, 2);
  EXPECT_TRUE(says(tree.err, "--unit-moving: the unit of " + mm + " is not known"));
  const CommandResult both =
      ist({"collide", mm, path("m.ist"), "--unit", "mm", "--unit-moving", "m"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_TRUE(says(both.err, "name the tree's mesh"));
  const CommandResult wrong = ist({"collide", path("mm.ist"), m, "--unit", "m"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(
      says(wrong.err, "--unit: " + path("mm.ist") + " says that its unit is mm: name the unit"));
  const CommandResult bite = ist_well(
      {"occlusion", mm, m, "--move", "4.05,0,0", "--unit", "mm", "--unit-moving", "m", "--json"});
  EXPECT_TRUE(says(bite.out, R"("unit":"mm","unit_assumed":false)"));
}

TEST_F(BodySizes, BodiesOfVeryDifferentSizesAreWarnedOf) {
  IST_SLOW();
  const std::string one = needle("one.stl", 4);
  const std::string units = ": if they are in different units, give --unit and --unit-moving";
  const auto warning = [&](double length) {
    const CommandResult result =
        collide(one, needle("other.stl", length), {"--voxel-size", "0.005"});
    EXPECT_EQ(result.exit_code, 0);
    return result.err;
  };
  EXPECT_EQ(warning(0.41), "");
  EXPECT_EQ(warning(39), "");
  EXPECT_EQ(warning(0.39), "warning: the largest extent of " + one + " is 4, and that of " +
                               path("other.stl") + " is 0.39" + units + "\n");
  EXPECT_TRUE(says(warning(41), "is 41" + units));
}

// Metres against millimetres: the warning comes first, and no voxel size is blamed.
TEST_F(BodySizes, AnotherUnitIsWarnedOfBeforeAnythingIsBuilt) {
  const std::string jaw = needle("mm.stl", 110), other = needle("m.stl", 0.1);
  const std::string part =
      "is 0.1: if they are in different units, give --unit and --unit-moving\n";
  const CommandResult people = ist({"collide", jaw, other});
  EXPECT_EQ(people.exit_code, 0) << people.err;
  EXPECT_TRUE(says(people.err, part));
  const CommandResult bite = ist({"occlusion", jaw, other, "--json"});
  EXPECT_EQ(bite.exit_code, 2);
  EXPECT_TRUE(says(bite.err, part));
  EXPECT_TRUE(says(bite.err,
                   "--unit-moving: m.stl would be 0.1 mm large, and jaws are 1 to 1000 mm: tell "
                   "its unit"));
  EXPECT_TRUE(says(collide(jaw, other).err, part));
}

TEST_F(BodySizes, AMemoryLimitBlamesNoVoxelsWhereThereAreNone) {
  const CommandResult result = ist({"occlusion", ball(), ball(), "--json", "--max-memory", "1K"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "ist: the mesh has 320 triangles, which need 71680 bytes of memory; 1024 are allowed: "
            "allow more memory, or simplify the mesh [memory-limit]\n");
}

TEST_F(BodySizes, VoxelsThatAreLargeForTheirBodyAreWarnedOf) {
  const std::string of = needle("needle.stl", 4), built = tree("fine.ist", "");
  const auto warning = [&](const char* size) {
    return without_notes(collide(built, of, {"--voxel-size", size}).err);
  };
  EXPECT_EQ(warning("0.08"), "");
  EXPECT_EQ(warning("0.081"),
            "warning: " + of +
                ": a voxel of 0.081 is more than 1/50 of the largest extent, 4: take smaller "
                "voxels for sharper answers\n");
  const CommandResult coarse = collide(ball_tree(), ball_tree(), {"--engine", "simd"});
  EXPECT_EQ(coarse.exit_code, 0);
  EXPECT_TRUE(says(coarse.err, "ball.ist: a voxel of 0.5 is more than 1/50"));
  const auto built_with = [&](const char* size) {
    return ist_well({"build", of, "-o", path("b.ist"), "--voxel-size", size, "--json"});
  };
  const std::string why = of + ": a voxel of 0.081 is more than 1/50 of the largest extent, 4";
  EXPECT_TRUE(says(built_with("0.081").err, "warning: " + why));
  EXPECT_TRUE(says(json_lines(built_with("0.081").out).at(0)["warnings"].dump(),
                   why.substr(why.rfind('/') + 1)));
  EXPECT_EQ(built_with("0.08").err, "");
}

}  // namespace
}  // namespace ist::test
