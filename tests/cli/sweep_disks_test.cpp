// Sweeps on disks that fail or are full. A part is there and whole, or not there. The table has the
// bytes of an undisturbed sweep.

#include <unistd.h>

#include "cli/sweep_case.h"
#include "support/effort.h"
#include "support/stability.h"

namespace ist::test {
namespace {

// Each call in turn fails, until none is left that could.
TEST_F(SweepCommand, ADiskThatFailsLeavesNothingHalfWritten) {
  StabilityCase seen("faults", "disk that fails in a sweep", "wrong outcomes");
  const std::string job = sweep_file({});
  make_whole(job, "whole");
  const Files all = results("whole");
  for (const char* call : {"fsync", "rename"}) {
    int refused = 0;
    for (bool fits = false; !fits; ++refused) {
      std::filesystem::remove_all(path("out"));
      const CommandResult result = with_failing_call(call, refused, arguments(job, "out"));
      fits = result.exit_code == 0;
      const Files left = results("out");
      bool whole = fits ? left == all : result.exit_code == 1 && says(result.err, ": cannot ");
      for (const auto& [name, bytes] : left)
        whole = whole && all.count(name) > 0 && all.at(name) == bytes;
      for (const auto& [name, bytes] : files("out")) {  // a part has a record, and a record a part
        if (name.starts_with("part-") && name.ends_with(".json"))
          whole = whole && exists("out/" + name.substr(0, 11) + ".npy");
      }
      seen.sample(!whole, 0, fmt::format("{} {}: {}", call, refused, result.err));
      sweep_well(job, "out");
      seen.sample(results("out") != all, 0, fmt::format("{} {}, made to the end", call, refused));
    }
    EXPECT_GE(refused, 10) << call;
    refused = 0;
    remove_table("out");
    for (bool fits = false; !fits; ++refused) {
      const Files before = files("out");
      const CommandResult result =
          with_failing_call(call, refused, arguments(job, "out", {"--merge"}));
      fits = result.exit_code == 0;
      const bool right =
          fits ? results("out") == all
               : result.exit_code == 1 && result.out.empty() && files("out") == before;
      seen.sample(!right, 0, fmt::format("{} {} of a merge: {}", call, refused, result.err));
    }
    EXPECT_GE(refused, 3) << call;
  }
}

TEST_F(SweepCommand, AFileThatGrowsTooLargeIsRemoved) {
  const std::string job = sweep_file({.count = 400, .rows_per_part = 200});
  make_whole(job, "whole");
  const auto limited = [&](int blocks, const std::vector<std::string>& more) {
    std::vector<std::string> words = arguments(job, "out", more);
    words.insert(words.begin(),
                 {"-c", fmt::format("ulimit -f {} && exec \"$@\"", blocks), "sh", IST_COMMAND});
    return run_command("/bin/sh", words);
  };
  for (const int blocks : {1, 8}) {  // of 512 bytes: too few for sweep.json, and for a part
    const CommandResult result = limited(blocks, {});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(says(result.err,
                     "cannot write the file: File too large: check the folder, its permissions and "
                     "the space on the disk"));
    EXPECT_EQ(names("out"),
              blocks == 1 ? std::vector<std::string>{} : std::vector<std::string>{"sweep.json"});
  }
  EXPECT_EQ(limited(48, {}).exit_code, 1);  // two parts fit, and the table does not
  EXPECT_EQ(parts_in("out"), 2);
  const Files parts = files("out");
  EXPECT_EQ(parts.size(), 5u);
  EXPECT_EQ(limited(48, {"--merge"}).exit_code, 1);
  EXPECT_TRUE(same(files("out"), parts));
  sweep_well(job, "out", {"--merge"});
  EXPECT_TRUE(same(results("out"), results("whole")));
}

// A disk of a few pages, of the system's memory, which only the processes of one shell see.
TEST_F(SweepCommand, ADiskThatIsFullIsUsedAgainWhenItHasRoom) {
  const std::string alone = ::geteuid() == 0 ? "unshare -m" : "unshare -rm";
  std::filesystem::create_directory(path("disk"));
  const std::string mounted = "mount -t tmpfs -o size=48k none " + path("disk");
  if (run_command("/bin/sh", {"-c", alone + " sh -c '" + mounted + "'"}).exit_code != 0) {
    IST_SKIP("this machine lets nobody mount a small disk");
  }
  const std::string job = sweep_file({.count = 100});
  make_whole(job, "whole");
  const std::string script = write(
      "script.sh",
      mounted + R"( || exit 99
cd ")" + dir_.path().string() +
          R"("
ist() { ")" IST_COMMAND
          R"(" sweep job.toml -o disk/out "$@" >> said 2>&1 && echo 0 >> codes || echo $? >> codes; }
ist
ls -A disk/out > full
ist --status --verify
mount -o remount,size=1m disk
ist
cp -r disk/out out
)");
  const CommandResult result = run_command("/bin/sh", {"-c", alone + " sh -eu " + script});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(file_content(path("codes")), "1\n0\n0\n") << file_content(path("said"));
  EXPECT_TRUE(
      says(file_content(path("said")),
           "No space left on device: check the folder, its permissions and the space on the disk"));
  const std::string full = file_content(path("full"));
  EXPECT_TRUE(says(full, "part-000001.npy"));
  EXPECT_FALSE(says(full, ".tmp"));
  EXPECT_FALSE(says(full, ".start-"));
  EXPECT_FALSE(says(full, "part-000009.npy"));
  EXPECT_TRUE(same(results("out"), results("whole")));
}

}  // namespace
}  // namespace ist::test
