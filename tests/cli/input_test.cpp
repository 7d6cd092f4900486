#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "answers/formats/csv_writer.h"
#include "answers/refusals.h"
#include "cli/cli_case.h"
#include "cli/commands/reports.h"
#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/german_locale.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/zip_file.h"

namespace ist::test {
namespace {

class Input : public CliTest {
 protected:
  // What a file does wrong: exit code 3, the file's name, what is wrong, and nothing written.
  void refuses(const std::vector<std::string>& arguments, const std::string& file,
               const std::string& part) const {
    const std::size_t before = dir_.entries();
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, file + ": "));
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(dir_.entries(), before);
  }
};

TEST_F(Input, MeshesThatAreNone) {
  const std::string out = path("out.ist"), list = poses({0}), good = ball();
  const std::pair<std::string, std::string> bad[] = {
      {path("none.stl"), "check"},
      {dir_.path(), "folder"},
      {write("empty.stl", ""), "empty"},
      {write("text.txt", "what it is, nobody knows\n"), "STL"},
      {write("cut.stl", file_content(good).substr(0, 1000)), "1000"}};
  for (const auto& [file, part] : bad) {
    refuses({"build", file, "-o", out, "--voxel-size", "0.5"}, file, part);
    refuses({"info", file}, file, "");
    refuses({"collide", file, good, "--voxel-size", "0.5", "--poses", list}, file, "");
    refuses({"collide", good, file, "--voxel-size", "0.5", "--poses", list}, file, "");
    refuses({"export", file, "--what", "voxels", "--level", "0", "-o", path("out.ply")}, file, "");
  }
  refuses({"export", good, "--what", "voxels", "--level", "0", "-o", path("out.ply")}, good,
          "ist build");
}

// No option changes the readers' limits, so the file is wrong, and not the usage.
TEST_F(Input, MeshesBeyondTheReadersLimits) {
  IST_SLOW();
  const std::string model = threemf_model(icosphere(1, 1));
  const std::string bomb = write("bomb.3mf", as_zip("3D/3dmodel.model", model, true, 0xF0000000u));
  refuses({"info", bomb}, bomb, "[mesh-too-large]");
  refuses({"build", bomb, "-o", path("out.ist")}, bomb, "it unpacks to 4026531840 bytes");
  std::string nodes = "{\"mesh\":0}", roots = "0";
  for (int i = 1; i < 30'000; ++i) {
    nodes += ",{\"mesh\":0}";
    roots += "," + std::to_string(i);
  }
  const std::string scene = write(
      "scene.gltf",
      replaced(replaced(as_gltf(icosphere(3, 1)), "\"nodes\":[0]", "\"nodes\":[" + roots + "]"),
               "[{\"mesh\":0}]", "[" + nodes + "]"));
  refuses({"info", scene}, scene, "[mesh-too-large]");
}

TEST_F(Input, TreesThatAreBroken) {
  const std::string tree = file_content(ball_tree()), list = poses({0}), good = ball();
  std::string flipped = tree;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
  for (const std::string& file :
       {write("cut.ist", tree.substr(0, tree.size() - 1)), write("longer.ist", tree + "x"),
        write("head.ist", tree.substr(0, 12)), write("flipped.ist", flipped)}) {
    refuses({"info", file}, file, "build");
    refuses({"collide", file, good, "--voxel-size", "0.5", "--poses", list}, file, "build");
  }
}

TEST_F(Input, TreesOfAnotherVersionAreRefusedWithTheRemedy) {
  std::string older = file_content(ball_tree());
  older[8] = 4;
  const std::string file = write("older.ist", older);
  const std::string why =
      "it is of version 4, and this program reads version 5: build it again from the mesh";
  refuses({"info", file}, file, why);
  refuses({"collide", file, ball(), "--poses", poses({0})}, file, why);
}

TEST_F(Input, PosesThatAreNone) {
  const std::string mesh = ball();
  const std::string good = R"({"pose":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  const auto list = [](const std::string& items) { return "[" + items + "]"; };
  const std::pair<std::string, std::string> bad[] = {
      {"", "line 1, column 1"},
      {"[\n {\"pose\": [1, 2,}\n]", "line 2, column 17"},
      {"{}", "array of objects"},
      {"17", "array of objects"},
      {"[]", "array of objects"},
      {list(good + ", 17"), "item 1"},
      {list(good + R"(, {"place": 3})"), "item 1"},
      {list(good + R"(, {"pose": 3})"), "item 1"},
      {list(good + R"(, {"pose":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0]})"), "item 1"},
      {list(good + R"(, {"pose":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1,0]})"), "item 1"},
      {list(R"({"pose":["1",0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "item 0"},
      {list(R"({"pose":[null,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "item 0"},
      {list(R"({"pose":[NaN,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "line 1, column 11"},
      {list(R"({"pose":[1e999,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "1e999"},
      {list(good + R"(,{"pose":[2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "item 1: not a rigid"},
      {list(good + R"(,{"pose":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "mirror"},
      {list(good + R"(,{"pose":[1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), "last row"}};
  for (const auto& [text, part] : bad) {
    SCOPED_TRACE(text);
    const std::string file = write("bad.json", text);
    refuses({"collide", mesh, mesh, "--voxel-size", "0.5", "--poses", file}, file, part);
  }
  refuses({"collide", mesh, mesh, "--voxel-size", "0.5", "--poses", path("none.json")},
          path("none.json"), "No such file");
}

TEST_F(Input, WhatIsWrongWithAMeshIsAWarning) {
  const std::string open = mesh("open.stl", open_strip(3));
  const CommandResult built =
      ist_well({"build", open, "-o", path("out.ist"), "--voxel-size", "0.5", "--json"});
  EXPECT_TRUE(says(built.err, "note: " + open + " is an open surface, as scans usually are"));
  const auto lines = json_lines(built.out);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["file"], "out.ist");
  ASSERT_GT(lines[0]["warnings"].size(), 0u);
  for (const nlohmann::json& warning : lines[0]["warnings"]) {
    EXPECT_TRUE(warning.get<std::string>().starts_with("open.stl: ")) << warning;
  }
  const CommandResult turned = ist_well({"build", mesh("turned.stl", inside_out(icosphere(1, 1))),
                                         "-o", path("turned.ist"), "--voxel-size", "0.5"});
  EXPECT_TRUE(says(turned.err, "inside out"));
  const CommandResult good =
      ist_well({"build", ball(), "-o", path("good.ist"), "--voxel-size", "0.08"});
  EXPECT_EQ(good.err, "");
  const CommandResult coarse =
      ist_well({"build", ball(), "-o", path("coarse.ist"), "--voxel-size", "0.5"});
  EXPECT_TRUE(says(coarse.err, "a voxel of 0.5 is more than 1/50 of the largest extent"));
}

TEST_F(Input, BadAndDirtyFilesOfOthers) {
  const auto folder = data_dir() / "bad_input";
  if (!std::filesystem::exists(folder)) IST_SKIP(folder << " is not there");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    SCOPED_TRACE(entry.path());
    const CommandResult result =
        ist({"build", entry.path(), "-o", path("out.ist"), "--voxel-size", "100"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.exit_code << result.err;
    EXPECT_EQ(exists("out.ist"), result.exit_code == 0);
    EXPECT_EQ(dir_.entries(), result.exit_code == 0 ? 1u : 0u);
    EXPECT_TRUE(result.exit_code == 0 || says(result.err, entry.path().string()));
    std::filesystem::remove(path("out.ist"));
  }
  EXPECT_GT(files, 0u);
}

// The command writes the same numbers in every locale, set by the environment or by a host program.

class CommandLocale : public GermanLocale {};

TEST_F(CommandLocale, OfTheEnvironmentChangesNoOutput) {
  IST_SLOW();
  const std::string ball = folder_.path() / "ball.stl";
  write_stl(icosphere(2, 2), ball);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", ball},
        {"collide", ball, ball, "--move", "3.25,0,0.125", "--voxel-size", "0.25"},
        {"collide", ball, ball, "--move", "4.125,0,0", "--voxel-size", "0.25"}}) {
    const CommandResult here = run_command(IST_COMMAND, arguments);
    language_.set(nullptr);
    const CommandResult elsewhere = run_command(IST_COMMAND, arguments);
    language_.set(kName);
    EXPECT_EQ(here.exit_code, elsewhere.exit_code) << here.err;
    EXPECT_EQ(here.out, elsewhere.out);
    EXPECT_TRUE(std::regex_search(here.out, std::regex("[0-9]\\.[0-9]"))) << here.out;
  }
}

TEST_F(CommandLocale, AdviceIsTheSame) {
  VoxelAdvice advice;
  advice.measured.resize(1);
  advice.measured.front().voxel_size = 0.125;
  advice.measured.front().error = 0.0625;
  advice.measured.front().slowest_query = 1234.5;
  for (const AdviceGoal::Of of : {AdviceGoal::Of::kError, AdviceGoal::Of::kSlowestQuery}) {
    expect_same([&] { return cli::why_none(advice, {of, 0.015}); });
  }
  advice.recommended = 0;
  expect_same([&] {
    ::testing::internal::CaptureStdout();
    cli::print_table(advice);
    cli::print_json(advice);
    cli::print_build_commands(0.125, "a.stl", "b.stl", 1'000'000);
    std::fflush(stdout);
    return ::testing::internal::GetCapturedStdout();
  });
}

TEST_F(CommandLocale, TablesAreTheSame) {
  const std::string file = folder_.path() / "table.csv";
  expect_same([&] {
    answers::CsvWriter csv(file, {"a", "b", "c"});
    csv.row(0.5, 1234567.25F, 1'000'000);
    csv.commit();
    return file_content(file);
  });
}

TEST_F(CommandLocale, NumbersAreReadAlike) {
  EXPECT_EQ(answers::numbers_of("0.5,-1.25e2"), (std::vector<double>{0.5, -125}));
  EXPECT_EQ(answers::numbers_of("0.5.5"), std::nullopt);
}

}  // namespace
}  // namespace ist::test
