// The unit that a mesh file states is taken. It is converted only if --unit-moving asks for it.

#include "cli/cli_case.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/zip_file.h"

namespace ist::test {
namespace {

using nlohmann::json;

// Two boxes that are 0.4 mm deep in each other, in millimetres and in inches.
class StatedUnits : public CliTest {
 protected:
  [[nodiscard]] std::string in(const std::string& name, const std::string& unit, double factor,
                               TriangleMesh of) const {
    for (Eigen::Vector3d& vertex : of.vertices) vertex *= factor;
    return write(name, as_3mf(replaced(threemf_model(of), "\"millimeter\"", "\"" + unit + "\"")));
  }
  [[nodiscard]] json answer(const std::string& fixed, const std::string& moving,
                            const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"collide", fixed, moving, "--depth", "0.00001", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string out = ist_well(arguments).out;
    return json::parse(out.substr(out.rfind('\n', out.size() - 2) + 1));
  }

  const TriangleMesh fixed_ = box({20, 30, 0}, {60, 50, 10}),
                     moving_ = box({25, 32, 9.6}, {55, 42, 19.6});
  const std::string mm_ = in("mm.3mf", "millimeter", 1, fixed_),
                    mm_moving_ = in("mm_moving.3mf", "millimeter", 1, moving_),
                    inch_ = in("inch.3mf", "inch", 1 / 25.4, fixed_),
                    inch_moving_ = in("inch_moving.3mf", "inch", 1 / 25.4, moving_);
};

TEST_F(StatedUnits, AreTaken) {
  const json mm = answer(mm_, mm_moving_), inch = answer(inch_, inch_moving_),
             mixed = answer(mm_, inch_moving_, {"--unit-moving", "inch"});
  EXPECT_NEAR(mm["depth_upper"].get<double>(), 0.4, 0.002);
  EXPECT_NEAR(inch["depth_upper"].get<double>(), 0.4 / 25.4, 0.002 / 25.4);
  EXPECT_NEAR(mixed["depth_upper"].get<double>(), 0.4, 0.002);
  EXPECT_TRUE(says(ist_well({"collide", mm_, inch_moving_, "--unit-moving", "inch"}).err,
                   inch_moving_ + " was converted from inch to mm"));
  const CommandResult unasked = ist({"collide", mm_, inch_moving_});
  EXPECT_EQ(unasked.exit_code, 2);
  EXPECT_TRUE(says(unasked.err, inch_moving_ + ": its unit is inch, and the unit of " + mm_ +
                                    " is mm: give --unit-moving inch to convert the mesh"));
  const std::string out = ist_well({"occlusion", inch_, inch_moving_, "--json"}).out;
  EXPECT_TRUE(says(out, "\"unit\":\"inch\"")) << out;
  EXPECT_FALSE(says(out, "\"unit_assumed\":true")) << out;
  EXPECT_TRUE(says(ist_well({"info", inch_}).out, " inch ("));
}

TEST_F(StatedUnits, AreNotContradicted) {
  const std::string tree = path("a.ist");
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    const CommandResult refused = ist(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0];
    return refused.err;
  };
  EXPECT_TRUE(says(refusal({"build", inch_, "-o", tree, "--unit", "mm"}),
                   inch_ + " says that its unit is inch: leave the option out"));
  EXPECT_FALSE(exists("a.ist"));
  const std::string stl = write("moving.stl", as_binary_stl(moving_)),
                    remedy =
                        " says that its unit is inch: name the unit of the first file by "
                        "--unit, and of the second by --unit-moving";
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{inch_, inch_moving_, "--unit", "mm"},
        {inch_, inch_moving_, "--unit", "inch", "--unit-moving", "mm"},
        {inch_, stl, "--unit", "mm"},
        {stl, inch_, "--unit", "mm"}}) {
    std::vector<std::string> arguments = {"collide"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_TRUE(says(refusal(arguments), remedy));
  }
  const json mixed = answer(inch_, stl, {"--unit", "inch", "--unit-moving", "mm"});
  EXPECT_NEAR(mixed["depth_upper"].get<double>(), 0.4 / 25.4, 0.002 / 25.4);
  ist_well({"build", inch_, "-o", tree, "--voxel-size", "0.1"});
  EXPECT_TRUE(says(ist_well({"info", "--json", tree}).out, "\"unit\":\"inch\""));
}

TEST_F(StatedUnits, OfTreesAreTakenBySweepsAndScenes) {
  const std::string mm = path("mm.ist"), inch = path("inch.ist");
  ist_well({"build", mm_, "-o", mm, "--voxel-size", "2"});
  ist_well({"build", inch_moving_, "-o", inch, "--voxel-size", "0.1"});
  const std::string job = write(
      "job.toml",
      "answers = [\"intersects\"]\n[fixed]\ntree = \"mm.ist\"\n[moving]\ntree = \"inch.ist\"\n"
      "[poses.box]\nseed = 1\ncount = 10\nfrom = [-1, -1, -1]\nto = [1, 1, 1]\nturns = \"any\"\n");
  const CommandResult swept = ist({"sweep", job, "-o", path("out")});
  EXPECT_NE(swept.exit_code, 0);
  EXPECT_TRUE(says(swept.err, inch + ": the tree is in inch, and " + mm + " is in mm"));
  const std::string scene = write(
      "scene.toml",
      "unit = \"mm\"\n[fixed]\nfile = \"mm.ist\"\n[held]\nfile = \"inch.ist\"\n[device]\n"
      "kind = \"hand\"\nplan = [{ time = 0, move = [0, 0, 50] }, { time = 0.01, move = [0, 0, 49] "
      "}]\n[effects.contact]\nstiffness = 2000\n");
  const CommandResult run = ist({"run", scene});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(says(run.err, inch + " is in inch: write this unit")) << run.err;
}

}  // namespace
}  // namespace ist::test
