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
    std::vector<std::string> arguments = {"collide", fixed, moving, "--depth", "0.001", "--json"};
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
  EXPECT_NEAR(inch["depth_upper"].get<double>(), 0.4 / 25.4, 0.002);
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
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"build", inch_, "-o", tree, "--unit", "mm"},
        {"collide", inch_, inch_moving_, "--unit", "mm"},
        {"collide", inch_, inch_moving_, "--unit", "inch", "--unit-moving", "mm"}}) {
    const CommandResult refused = ist(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0];
    EXPECT_TRUE(says(refused.err, " says that its unit is inch: leave the option out"))
        << refused.err;
  }
  EXPECT_FALSE(exists("a.ist"));
  ist_well({"build", inch_, "-o", tree, "--voxel-size", "0.1"});
  EXPECT_TRUE(says(ist_well({"info", "--json", tree}).out, "\"unit\":\"inch\""));
}

}  // namespace
}  // namespace ist::test
