// What becomes of a sweep whose processes are killed, interrupted or held. A part is there and
// whole, or not there; and the table is that of an undisturbed sweep.

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "cli/sweep_case.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

TEST_F(SweepCommand, RefusesAPartThatALivingProcessMakes) {
  const std::string job = sweep_file({});
  sweep_well(job, "out", {"--share", "99/100"});  // makes the folder, and no part
  Process held = with_held_call("fsync", 0, arguments(job, "out", {"--share", "0/3"}));
  await_hold(held);
  const auto refuses = [&](const std::string& share) {
    const Files before = files("out");
    const CommandResult result = sweep(job, "out", {"--share", share});
    EXPECT_EQ(result.exit_code, 3) << share;
    EXPECT_TRUE(says(result.err,
                     "part-000000.npy: another process is making this part now: shares "
                     "overlap; give each process a share of its own (--share k/N)"));
    EXPECT_TRUE(same(files("out"), before));
  };
  refuses("0/1");
  held.signal(SIGSTOP);  // a process that stands still lives
  refuses("0/2");
  sweep_well(job, "out", {"--share", "1/3"});
  sweep_well(job, "out", {"--share", "2/3"});
  EXPECT_TRUE(says(sweep_well(job, "out", {"--status"}).out, "\nrunning  0\nmissing  0\n"));
  const CommandResult merged = sweep(job, "out", {"--merge"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_TRUE(says(merged.err, "nothing was merged: 0\n"));

  held.signal(SIGKILL);
  EXPECT_EQ(held.wait().exit_code, 128 + SIGKILL);
  EXPECT_TRUE(says(sweep_well(job, "out").out, "parts   made 1, there before 2, given up 0\n"));
  EXPECT_EQ(marks_in("out"), 0);
}

// Whoever looks at a mark locks it for a moment, which makes nobody believe that its process lives.
TEST_F(SweepCommand, WhoLooksAtAMarkIsNotTakenForItsMaker) {
  const std::string job = sweep_file({});
  sweep_well(job, "out", {"--share", "99/100"});
  write("out/part-000000.start-1", "");
  const int descriptor = ::open(path("out/part-000000.start-1").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(descriptor, 0);
  ASSERT_EQ(::flock(descriptor, LOCK_SH), 0);
  EXPECT_EQ(object_of(sweep_well(job, "out", {"--status", "--json"}))["running"],
            nlohmann::json::array());
  ASSERT_EQ(::flock(descriptor, LOCK_EX), 0);
  EXPECT_EQ(object_of(sweep_well(job, "out", {"--status", "--json"}))["running"],
            nlohmann::json{0});
  EXPECT_EQ(sweep(job, "out").exit_code, 3);
  ASSERT_EQ(::flock(descriptor, LOCK_SH), 0);
  EXPECT_TRUE(says(sweep_well(job, "out").out, "parts   made 3, there before 0, given up 0\n"));
  ::close(descriptor);
}

TEST_F(SweepCommand, GivesUpAPartThatWasLostThreeTimes) {
  const std::string job = sweep_file({});
  make_whole(job, "whole");
  sweep_well(job, "out", {"--share", "99/100"});
  for (int start = 1; start <= 3; ++start) {
    Process held = with_held_call("fsync", 0, arguments(job, "out", {"--share", "1/3"}));
    await_hold(held);
    held.signal(SIGKILL);
    EXPECT_EQ(held.wait().exit_code, 128 + SIGKILL);
    EXPECT_EQ(marks_in("out"), start);
    EXPECT_FALSE(exists("out/part-000001.npy"));
  }
  const std::string given_up =
      "ist: given up, for 3 processes that began each were lost: 1; remove the files .start-1 to "
      ".start-3 of a part to try it again\n";
  const CommandResult run = sweep(job, "out");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out,
            "parts   made 2, there before 0, given up 1\n"
            "rows    not merged yet: parts are missing\n");
  EXPECT_TRUE(run.err.ends_with(given_up)) << run.err;
  const CommandResult merged = sweep(job, "out", {"--merge"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(merged.err, given_up);
  EXPECT_FALSE(exists("out/rows.npy"));
  EXPECT_TRUE(says(sweep_well(job, "out", {"--status"}).out, "\ngiven up 1\n"));

  std::filesystem::remove(path("out/part-000000.npy"));
  sweep_well(job, "out", {"--share", "2/3"});
  const CommandResult both = sweep(job, "out", {"--merge"});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_TRUE(
      says(both.err, "ist: parts are missing, and nothing was merged: 0\nist: given up, for 3 "));

  for (int start = 1; start <= 3; ++start) {
    EXPECT_TRUE(std::filesystem::remove(path(fmt::format("out/part-000001.start-{}", start))));
  }
  EXPECT_TRUE(says(sweep_well(job, "out").out, "parts   made 2, there before 1, given up 0\n"));
  EXPECT_TRUE(files("out")["rows.npy"] == files("whole")["rows.npy"]);
}

// Each process makes 20 parts at most, and is held in the next one, so it hears the signal before
// its end.
TEST_F(SweepCommand, ASignalLeavesWholePartsAndNothingElse) {
  StabilityCase seen("faults", "signal in a sweep", "wrong outcomes");
  const std::string job =
      sweep_file({.count = 100000, .rows_per_part = 200, .answers = R"("penetration")"});
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Process process =
        with_held_call("fsync", 2 * 20 + 1, arguments(job, "out", {"--threads", "1"}));
    const std::ptrdiff_t before = parts_in("out");
    await(process, [&] { return parts_in("out") >= before + 3; });
    process.signal(signal);
    await_heard(1, process);
    release();
    const CommandResult result = process.wait();
    const std::ptrdiff_t parts = parts_in("out");
    const auto all = static_cast<std::size_t>(2 * parts + 1);
    const bool clean =
        result.exit_code == 130 && result.out.empty() && says(result.err, "ist: interrupted") &&
        parts >= before + 3 && parts <= before + 21 && names("out").size() == all &&
        object_of(sweep_well(job, "out", {"--status", "--verify", "--json"}))["done"] == parts;
    seen.sample(!clean, 0, fmt::format("signal {}, {}: {}", signal, result.exit_code, result.err));
  }
}

// A block of 4096 rows, the first that could be written, takes some 20 minutes: two equal bodies
// lie in nearly the same place. The signal ends the part long before.
TEST_F(SweepCommand, ASignalEndsAPartThatTakesLong) {
  ist_well({"build", mesh("fine.stl", icosphere(5, 2)), "-o", path("ball.ist"), "--spheres",
            "tight", "--voxel-size", "0.1"});
  const std::string job = sweep_file({.count = 4096,
                                      .rows_per_part = 4096,
                                      .answers = R"("penetration")",
                                      .tolerance = "0.00",
                                      .from = "[0, -0.03, -0.03]",
                                      .to = "[0.03, 0.03, 0.03]"});
  Process process(IST_COMMAND, arguments(job, "out", {"--threads", "1"}));
  await(process, [&] { return begun_in("out") > 0; });
  process.signal(SIGINT);
  const CommandResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130);
  // The signal may come while the trees are still being read.
  EXPECT_TRUE(result.err == "ist: interrupted: 0 parts were made, and part 0 left no file\n" ||
              result.err == "ist: interrupted\n")
      << result.err;
  EXPECT_EQ(names("out"), std::vector<std::string>{"sweep.json"});
}

TEST_F(SweepCommand, ASignalWhileTreesAreLoadedLeavesNoPart) {
  static_cast<void>(ball_tree("ball.ist", "tight", {"--voxel-size", "0.03"}));
  const std::string job = sweep_file({});
  const std::vector<std::string> words = arguments(job, "out", {"--threads", "1"});
  sweep_well(job, "out", {"--share", "99/100"});
  // It is held at the lock of its mark, before it loads a tree.
  Process held = with_held_call("flock", 0, words);
  await_hold(held);
  EXPECT_EQ(marks_in("out"), 1);
  held.signal(SIGINT);
  await_heard(1, held);
  release();
  const CommandResult early = held.wait();
  EXPECT_EQ(early.exit_code, 130) << early.err;
  EXPECT_TRUE(says(early.err, "ist: interrupted"));
  EXPECT_EQ(names("out"), std::vector<std::string>{"sweep.json"});
  // While it loads them, or later.
  for (int i = 0; i < 3; ++i) {
    Process process(IST_COMMAND, words);
    await(process, [&] { return marks_in("out") > 0; });
    process.signal(SIGINT);
    const CommandResult result = process.wait();
    const std::ptrdiff_t parts = parts_in("out");
    if (parts < 3) {
      EXPECT_EQ(result.exit_code, 130) << result.err;
      EXPECT_TRUE(says(result.err, "ist: interrupted"));
    }
    EXPECT_EQ(names("out").size(), static_cast<std::size_t>(2 * parts + 1));
    std::filesystem::remove_all(path("out"));
    sweep_well(job, "out", {"--share", "99/100"});
  }
}

// Three kills in each folder: while the second part is stored, behind a new part, and at a random
// moment. At last an end in peace. A process that is killed may leave temporary files; marks go
// with the part.
TEST_F(SweepCommand, KillsLeaveWholePartsAndTheSameTable) {
  IST_SLOW();
  StabilityCase seen("faults", "SIGKILL in a sweep", "wrong outcomes");
  const std::string job = sweep_file(
      {.count = 6000, .rows_per_part = 200, .answers = R"("intersects", "penetration")"});
  make_whole(job, "whole");
  const Files whole = results("whole");
  const auto is_whole = [&](const std::string& folder) {
    for (const auto& [name, bytes] : results(folder)) {
      if (name.ends_with(".npy") && bytes != whole.at(name)) return false;
    }
    return true;
  };
  const auto remove_marks = [&](const std::string& folder) {
    for (const std::string& name : names(folder)) {
      if (says(name, ".start-")) std::filesystem::remove(path(folder + "/" + name));
    }
  };
  Random random(17);
  const auto kill = [&](Process& process, const std::string& folder) {
    process.signal(SIGKILL);
    const CommandResult result = process.wait();
    const bool killed = result.exit_code == 128 + SIGKILL;
    const bool right = (killed || result.exit_code == 0) && is_whole(folder);
    seen.sample(!right, 0, fmt::format("{}: {}", result.exit_code, result.err));
    return killed;
  };
  const int rounds = samples(1);
  for (int round = 0; round < rounds; ++round) {
    const std::string folder = fmt::format("out-{}", round);
    const std::vector<std::string> words = arguments(job, folder, {"--threads", "1"});
    // The folder's record is stored first, and a part with its record needs two calls.
    Process held = with_held_call("fsync", 3, words);
    await_hold(held);
    EXPECT_TRUE(kill(held, folder));
    EXPECT_EQ(parts_in(folder), 1);

    const std::ptrdiff_t before = parts_in(folder);
    Process behind(IST_COMMAND, words);
    await(behind, [&] { return parts_in(folder) > before; });
    kill(behind, folder);
    EXPECT_GT(parts_in(folder), before);

    Process anywhere(IST_COMMAND, words);
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(400'000)));
    kill(anywhere, folder);

    if (sweep(job, folder).exit_code == 1) {  // all three met one part
      remove_marks(folder);
      sweep_well(job, folder);
    }
    Files made = results(folder);
    std::erase_if(made, [](const auto& file) { return file.first.ends_with(".tmp"); });
    seen.sample(made != whole, 0, "the table after three kills");
    std::filesystem::remove_all(path(folder));
  }
}

// The record gets its name before its part, so a part that is there has one.
TEST_F(SweepCommand, AKillBetweenTwoNamesLeavesNoPart) {
  const std::string job = sweep_file({});
  make_whole(job, "whole");
  sweep_well(job, "out", {"--share", "99/100"});
  Process held = with_held_call("rename", 1, arguments(job, "out"));
  await_hold(held);
  EXPECT_TRUE(exists("out/part-000000.json"));
  EXPECT_FALSE(exists("out/part-000000.npy"));
  held.signal(SIGKILL);
  EXPECT_EQ(held.wait().exit_code, 128 + SIGKILL);
  EXPECT_TRUE(says(sweep_well(job, "out", {"--status"}).out, "\nmissing  0-2\n"));
  EXPECT_TRUE(says(sweep_well(job, "out").out, "parts   made 3, there before 0, given up 0\n"));
  EXPECT_TRUE(files("out")["rows.npy"] == files("whole")["rows.npy"]);
}

}  // namespace
}  // namespace ist::test
