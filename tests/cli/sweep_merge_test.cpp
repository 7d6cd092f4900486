// The merge of a sweep's parts: by the process that makes the last one, once, and again if it was
// killed.

#include <csignal>
#include <deque>

#include "cli/sweep_case.h"

namespace ist::test {
namespace {

using nlohmann::json;

// The sweep has three parts. Its calls to store and to name files: one of sweep.json, two of each
// part, then those of rows.npy and manifest.json.
constexpr int kBeforeMerge = 1 + 2 * 3;

class SweepMerge : public SweepCommand {
 protected:
  SweepMerge() { make_whole(job_, "whole"); }

  // Whether the folder has the files of an undisturbed sweep, beside what a kill leaves.
  [[nodiscard]] ::testing::AssertionResult is_whole(const std::string& folder) const {
    Files found = results(folder);
    std::erase_if(found, [](const auto& file) { return file.first.ends_with(".tmp"); });
    return same(found, results("whole"));
  }

  const std::string job_ = sweep_file({});
};

TEST_F(SweepMerge, ProcessesThatFinishAtOnceMakeOneTable) {
  for (int round = 0; round < 5; ++round) {
    const std::string folder = fmt::format("out-{}", round);
    std::deque<Process> shares;
    for (const char* share : {"0/3", "1/3", "2/3"}) {
      shares.emplace_back(IST_COMMAND, arguments(job_, folder, {"--share", share, "--json"}));
    }
    for (Process& share : shares) {
      const CommandResult result = share.wait();
      EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    EXPECT_TRUE(is_whole(folder));
    EXPECT_FALSE(exists(folder + "/rows.start"));
  }
}

TEST_F(SweepMerge, OneProcessMergesAndItsKillLeavesTheMergeToTheNext) {
  Process held = with_held_call("fsync", kBeforeMerge, arguments(job_, "out"));
  await_hold(held);
  EXPECT_EQ(parts_in("out"), 3);
  EXPECT_TRUE(exists("out/rows.start"));
  EXPECT_FALSE(exists("out/rows.npy"));
  EXPECT_EQ(sweep_well(job_, "out").out,
            "parts   made 0, there before 3, given up 0\n"
            "rows    another process is merging them\n");
  const CommandResult second = sweep(job_, "out", {"--merge"});
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_TRUE(
      says(second.err, "out/rows.npy: another process is merging the parts now: wait for it"));

  held.signal(SIGKILL);
  EXPECT_EQ(held.wait().exit_code, 128 + SIGKILL);
  EXPECT_FALSE(exists("out/rows.npy"));
  EXPECT_TRUE(says(sweep_well(job_, "out").out,
                   "parts   made 0, there before 3, given up 0\nrows    25 in "));
  EXPECT_TRUE(is_whole("out"));
  EXPECT_FALSE(exists("out/rows.start"));
}

TEST_F(SweepMerge, AKillBetweenTheNamesOfTableAndManifestIsMended) {
  Process held = with_held_call("rename", kBeforeMerge + 1, arguments(job_, "out"));
  await_hold(held);
  EXPECT_TRUE(exists("out/rows.npy"));
  EXPECT_FALSE(exists("out/manifest.json"));
  held.signal(SIGKILL);
  EXPECT_EQ(held.wait().exit_code, 128 + SIGKILL);
  sweep_well(job_, "out");
  EXPECT_TRUE(is_whole("out"));
}

TEST_F(SweepMerge, SaysThatNothingIsLeftToDo) {
  const Files before = files("whole");
  const CommandResult again = sweep_well(job_, "whole", {"--merge"});
  EXPECT_EQ(again.out,
            fmt::format("rows    25 in {}/rows.npy: nothing is left to do\n", path("whole")));
  EXPECT_TRUE(same(files("whole"), before));
  EXPECT_EQ(object_of(sweep_well(job_, "whole", {"--merge", "--json"}))["rows"], 25);

  // A table that is damaged or gone is merged again.
  std::string rows = before.at("rows.npy");
  rows.back() = static_cast<char>(rows.back() ^ 1);
  write("whole/rows.npy", rows);
  EXPECT_EQ(sweep_well(job_, "whole", {"--merge"}).out,
            fmt::format("rows    25 in {}/rows.npy\n", path("whole")));
  EXPECT_TRUE(same(files("whole"), before));
  remove_table("whole");
  sweep_well(job_, "whole");
  EXPECT_TRUE(same(files("whole"), before));
}

// What a sweep file names may be the mesh itself.
TEST_F(SweepMerge, AMeshAnswersAsItsTree) {
  std::string text = text_of({.answers = R"("intersects")"});
  const std::string tree = write("tree.toml", text), table = "[moving]\ntree = \"ball.ist\"";
  text.replace(text.find(table), table.size(), "[moving]\nfile = \"ball.stl\"");
  const std::string mesh = write("mesh.toml", text);
  make_whole(tree, "tree");
  make_whole(mesh, "mesh");
  for (const char* name : {"index", "x", "y", "z", "qw", "intersects"}) {
    EXPECT_EQ(column("mesh", name), column("tree", name)) << name;
  }
  const json header =
      json::parse(sweep_well(mesh, "mesh", {"--json"})
                      .out.substr(0, sweep_well(mesh, "mesh", {"--json"}).out.find('\n')));
  EXPECT_EQ(header["moving"]["file"], "ball.stl");
}

}  // namespace
}  // namespace ist::test
