#include <fmt/format.h>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/zip_file.h"

namespace ist::test {
namespace {

using nlohmann::json;

class TreePair : public CliTest {
 protected:
  // Returns the error of a sweep of two trees that cannot be compared.
  [[nodiscard]] std::string refused_sweep(const std::string& fixed,
                                          const std::string& moving) const {
    const std::string job = write(
        "job.toml",
        fmt::format("answers = [\"intersects\"]\n[fixed]\ntree = \"{}\"\n[moving]\ntree = \"{}\"\n"
                    "[poses.box]\nseed = 1\ncount = 10\nfrom = [-1, -1, -1]\nto = [1, 1, 1]\n"
                    "turns = \"any\"\n",
                    fixed, moving));
    const CommandResult result = ist({"sweep", job, "-o", path("out")});
    EXPECT_NE(result.exit_code, 0);
    return result.err;
  }
};

// A plate, and a ball 0.2 deep in it, as two programs store them: one in RAS, one in LPS.
class Frames : public TreePair {
 protected:
  [[nodiscard]] std::string in(PatientFrame frame, const std::string& name, TriangleMesh of) const {
    of.frame = PatientFrame::kRas;
    turn_into(of, frame);
    write_stl(of, path(name));
    return path(name);
  }
  [[nodiscard]] CommandResult collide(const std::string& fixed, const std::string& moving,
                                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"collide", fixed, moving};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ist(arguments);
  }

  const TriangleMesh plate_ = box({10, 20, -3}, {20, 30, 0});
  TriangleMesh ball_ = [] {
    TriangleMesh ball = icosphere(3, 2);
    for (Eigen::Vector3d& vertex : ball.vertices) vertex += Eigen::Vector3d(15, 25, 1.8);
    return ball;
  }();
  const std::string ras_ = in(PatientFrame::kRas, "plate.stl", plate_),
                    lps_ = in(PatientFrame::kLps, "ball.stl", ball_),
                    plain_ = mesh("plain.stl", ball_);
};

TEST_F(Frames, TwoInOneQueryAreRefused) {
  const CommandResult refused = collide(ras_, lps_);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(says(refused.err, lps_ + ": its frame is lps, and the frame of " + ras_ + " is ras"));
  EXPECT_TRUE(says(refused.err, "--to-frame ras"));
  const std::vector<std::vector<std::string>> others = {
      {"occlusion", ras_, lps_, "--json"},
      {"approach", ras_, lps_, "--axis", "z", "--from", "0", "--to", "1"},
      {"advise", ras_, lps_, "--error", "0.1"},
      {"bench", ras_, lps_}};
  for (const std::vector<std::string>& arguments : others) {
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_TRUE(says(result.err, "its frame is lps, and the frame of " + ras_ + " is ras"));
  }
}

TEST_F(Frames, TwoInASweepAreRefused) {
  const std::string ras = path("ras.ist"), lps = path("lps.ist");
  ist_well({"build", ras_, "-o", ras, "--voxel-size", "0.5"});
  ist_well({"build", lps_, "-o", lps, "--voxel-size", "0.5"});
  EXPECT_TRUE(says(refused_sweep("ras.ist", "lps.ist"),
                   lps + " is in the frame lps, and " + ras + " is in ras"));
}

// Labels lie where the mesh lies: a turned and converted mesh keeps them.
TEST_F(Frames, LabelsAreTurnedAndConvertedWithTheirMesh) {
  std::string obj = "# SPACE=LPS\n";
  for (const Eigen::Vector3d& vertex : ball_.vertices) {
    obj += fmt::format("v {} {} {}\n", -1e-3 * vertex[0], -1e-3 * vertex[1], 1e-3 * vertex[2]);
  }
  obj += "g tooth_16\n";
  for (const auto& [a, b, c] : ball_.triangles) {
    obj += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  const std::string ball = write("ball.obj", obj);
  const CommandResult bite =
      ist_well({"occlusion", ras_, ball, "--to-frame", "ras", "--unit", "mm", "--unit-moving", "m",
                "--labels-moving", ball, "--numbering", "fdi", "--json"});
  EXPECT_TRUE(says(bite.out, R"("teeth":[{"number":16)"));
}

TEST_F(Frames, OcclusionFiles_NameTheFrameOfTheirCoordinates) {
  const std::string ball = in(PatientFrame::kLps, "lps_ball.stl", ball_),
                    plate = in(PatientFrame::kLps, "lps_plate.stl", plate_);
  ist_well(
      {"occlusion", plate, ball, "-o", path("b.ply"), "-o", path("b.vtp"), "-o", path("b.json")});
  EXPECT_TRUE(says(file_content(path("b.ply")), "\ncomment SPACE=LPS\n"));
  EXPECT_EQ(read_mesh(path("b.ply")).frame, PatientFrame::kLps);
  EXPECT_TRUE(says(file_content(path("b.vtp")),
                   "Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">76 80 83 0<"));
  EXPECT_EQ(json::parse(file_content(path("b.json")))["frame"], "lps");
  ist_well({"occlusion", plate, ball, "--open", "3", "-o", path("open.ply")});
  EXPECT_FALSE(says(file_content(path("open.ply")), "SPACE"));
  ist_well({"occlusion", plain_, plain_, "-o", path("p.ply"), "-o", path("p.vtp"), "-o",
            path("p.json")});
  EXPECT_FALSE(says(file_content(path("p.ply")), "SPACE"));
  EXPECT_FALSE(says(file_content(path("p.vtp")), "SPACE"));
  EXPECT_EQ(json::parse(file_content(path("p.json")))["frame"], nullptr);
}

TEST_F(Frames, AMeshIsTurnedIfThatIsAsked) {
  const std::string truth = collide(ras_, plain_, {"--depth", "0.001"}).out;
  EXPECT_TRUE(says(truth, "touch      yes"));
  const CommandResult turned = collide(ras_, lps_, {"--depth", "0.001", "--to-frame", "RAS"});
  EXPECT_EQ(turned.out, truth);
  EXPECT_TRUE(says(turned.err, lps_ + " was turned from the frame lps to ras"));
  EXPECT_TRUE(says(collide(ras_, lps_, {"--to-frame", "lps"}).out, "touch      yes"));
  const CommandResult plain = collide(ras_, plain_, {"--to-frame", "ras"});
  EXPECT_TRUE(says(plain.err, plain_ + " does not say its frame, and stays as it is"));
  EXPECT_TRUE(says(collide(ras_, plain_, {"--json"}).out, R"("frame":"ras")"));
}

TEST_F(Frames, ATreeKeepsItsMeshesFrame) {
  const std::string tree = path("ball.ist");
  ist_well({"build", lps_, "-o", tree, "--voxel-size", "0.5"});
  EXPECT_EQ(read_tree(tree).frame(), PatientFrame::kLps);
  EXPECT_TRUE(says(ist_well({"info", tree}).out, "frame lps: +x to the patient's left"));
  EXPECT_TRUE(says(ist_well({"info", lps_}).out, "frame lps"));
  EXPECT_EQ(json_lines(ist_well({"info", "--json", tree}).out).at(0)["frame"], "lps");
  EXPECT_EQ(json_lines(ist_well({"info", "--json", plain_}).out).at(0)["frame"], nullptr);
  ist_well({"export", tree, "--what", "voxels", "--level", "0", "-o", path("v.ply")});
  EXPECT_EQ(read_mesh(path("v.ply")).frame, PatientFrame::kLps);
  EXPECT_EQ(collide(ras_, tree).exit_code, 2);
  const CommandResult fixed = collide(ras_, tree, {"--to-frame", "ras"});
  EXPECT_EQ(fixed.exit_code, 2);
  EXPECT_TRUE(says(fixed.err, "ist build --to-frame ras"));
  EXPECT_TRUE(says(collide(ras_, tree).err, "give --to-frame lps to turn the mesh"));
  EXPECT_TRUE(says(collide(ras_, tree, {"--to-frame", "lps"}).out, "touch      yes"));
  const CommandResult untold =
      ist({"build", plain_, "-o", path("no.ist"), "--voxel-size", "0.5", "--to-frame", "ras"});
  EXPECT_EQ(untold.exit_code, 2);
  EXPECT_TRUE(says(untold.err, "--to-frame: " + plain_ + " does not say its frame"));
  ist_well({"build", lps_, "-o", tree, "--voxel-size", "0.5", "--to-frame", "ras"});
  EXPECT_TRUE(says(collide(ras_, tree).out, "touch      yes"));
}

TEST_F(Frames, BuildTakesNoOtherFrameThanTheFiles) {
  const std::string tree = path("t.ist");
  const auto build = [&](const std::string& of, const std::string& frame) {
    return ist({"build", of, "-o", tree, "--voxel-size", "0.5", "--frame", frame});
  };
  EXPECT_EQ(build(plain_, "lps").exit_code, 0);
  EXPECT_EQ(read_tree(tree).frame(), PatientFrame::kLps);
  EXPECT_EQ(build(lps_, "LPS").exit_code, 0);
  const CommandResult refused = build(lps_, "ras");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(says(refused.err, "--frame: " + lps_ + " says that its frame is lps"));
}

TEST_F(Frames, OfFilesNameTheSides) {
  const std::string ball = in(PatientFrame::kRas, "ras_ball.stl", ball_);
  const auto bite = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"occlusion", ras_, ball, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ist(arguments);
  };
  const std::string told = bite({}).out;
  EXPECT_EQ(told, bite({"--frame", "ras"}).out);
  EXPECT_TRUE(says(told, "left")) << told;
  EXPECT_TRUE(says(told, "anterior"));
  const CommandResult other = bite({"--frame", "lps"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(says(other.err, "--frame: it is lps, and the files are in ras"));
  EXPECT_TRUE(says(bite({"--left", "1,0,0"}).err, "--left: it points to the right"));
  EXPECT_EQ(bite({"--left", "-1,0.2,0"}).exit_code, 0);
}

// The unit that a mesh file states is taken. It is converted only if --unit-moving asks for it.

// Two boxes that are 0.4 mm deep in each other, in millimetres and in inches.
class StatedUnits : public TreePair {
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
  EXPECT_TRUE(
      says(refused_sweep("mm.ist", "inch.ist"), inch + " is in inch, and " + mm + " is in mm"));
  const std::string scene = write(
      "scene.toml",
      "unit = \"mm\"\n[fixed]\nfile = \"mm.ist\"\n[held]\nfile = \"inch.ist\"\n[device]\n"
      "kind = \"hand\"\nplan = [{ time = 0, move = [0, 0, 50] }, { time = 0.01, move = [0, 0, 49] "
      "}]\n[effects.contact]\n");
  const CommandResult run = ist({"run", scene});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(says(run.err, inch + " is in inch: write this unit")) << run.err;
}

}  // namespace
}  // namespace ist::test
