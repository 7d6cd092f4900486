// Signals to `ist run`: the first ends it in order, with a recording that is whole.

#include <csignal>
#include <filesystem>
#include <utility>

#include "cli/run_signals_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

TEST_F(RunSignals, TwoAtOnceAreOne) {
  IST_SLOW();
  const std::string file = path("ticks.jsonl");
  const std::pair<int, int> pairs[] = {{SIGINT, SIGINT}, {SIGINT, SIGTERM}, {SIGHUP, SIGINT}};
  for (int round = 0; round < 4; ++round) {
    for (const auto& [first, second] : pairs) {
      const bool paced = round % 2 == 1;
      Process process = with_own_clock(paced ? endless_paced(file) : endless(file, {"--unpaced"}));
      await_ticks(process);
      process.signal(first);
      process.signal(second);
      const CommandResult result = process.wait();
      ASSERT_TRUE(exists("ticks.jsonl")) << result.exit_code;
      expect_order(result, file_content(file), paced);
      EXPECT_EQ(unfinished_bytes(), 0u);
      std::filesystem::remove(file);
    }
  }
}

TEST_F(RunSignals, TwoWithinASecondAreOne) {
  for (int round = 0; round < 3; ++round) {
    const std::string file = pipe("ticks.jsonl");
    HeldPipe slow(file);
    Process process = with_own_clock(endless_paced(file));
    slow.await_full(process);  // the disk does not take the rest, so the run cannot end in order
    process.signal(SIGINT);
    await_heard(1, process);
    set_clock(999);
    process.signal(SIGINT);
    await_heard(2, process);
    EXPECT_FALSE(waits_for_files());
    EXPECT_TRUE(process.is_running());
    const std::string text = slow.read_to_the_end_of(process);
    expect_order(process.wait(), text, true);
    std::filesystem::remove(file);
  }
}

// It signals the process, and then its group. SIGALRM is its own timer.
TEST_F(RunSignals, OfTimeoutEndARunInOrder) {
  IST_SLOW();
  const std::string file = path("ticks.jsonl");
  for (int round = 0; round < 4; ++round) {
    std::vector<std::string> arguments = words_with_own_clock(endless_paced(file));
    arguments.insert(arguments.begin(), {"-s", "INT", "100000"});
    Process process("/usr/bin/timeout", arguments);
    await_ticks(process);
    process.signal(SIGALRM);
    CommandResult result = process.wait();
    EXPECT_EQ(result.exit_code, 124) << "of timeout itself";
    result.exit_code = 0;
    ASSERT_TRUE(exists("ticks.jsonl"));
    expect_order(result, file_content(file), true);
    EXPECT_EQ(unfinished_bytes(), 0u);
    std::filesystem::remove(file);
  }
}

TEST_F(RunSignals, ThatQuitLeaveNothing) {
  const std::string file = path("ticks.jsonl");
  const std::vector<std::string> arguments = endless(file, {"--unpaced"});
  const std::size_t entries = dir_.entries();
  for (int round = 0; round < 2; ++round) {
    Process running = with_own_clock(arguments);
    await_ticks(running);
    expect_end_by(SIGQUIT, running);
    EXPECT_EQ(dir_.entries(), entries);

    // While it ends in order, its recording is stored, but has no name yet.
    Process ending = with_held_call("fsync", 0, arguments);
    await_ticks(ending);
    ending.signal(SIGINT);
    await_hold(ending);
    expect_end_by(SIGQUIT, ending);
    EXPECT_EQ(dir_.entries(), entries);
  }
  // At any moment of its end in order. Once the recording has its name, it stays.
  for (int round = 0; round < 3; ++round) {
    Process process = with_own_clock(arguments);
    await_ticks(process);
    process.signal(SIGINT);
    process.signal(SIGQUIT);
    const CommandResult result = process.wait();
    EXPECT_EQ(unfinished_bytes(), 0u);
    const bool recorded = exists("ticks.jsonl");
    if (recorded) {
      EXPECT_GT(ticks_in(file_content(file), false), 0u);
    }
    if (result.exit_code == 0) {
      expect_order(result, file_content(file), false);
    } else {
      EXPECT_EQ(result.exit_code, 128 + SIGQUIT);
    }
    EXPECT_EQ(dir_.entries(), entries + (recorded ? 1 : 0));
    std::filesystem::remove(file);
  }
}

TEST_F(RunSignals, EndARunAtOnceThatWaitsForAReader) {
  const std::string file = pipe("ticks.jsonl");
  Process process = with_told_call("open", 0, endless(file, {"--unpaced"}));
  await_hold(process);
  expect_end_by(SIGINT, process);
}

TEST_F(RunSignals, EndAReplayInOrder) {
  const std::string scene = boxes(), whole = path("whole.jsonl"), again = path("again.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "0.4", "--record", whole}));
  const std::vector<std::string> lines = lines_of(file_content(whole));
  ASSERT_EQ(lines.size(), 401u);
  for (const std::size_t ticks : {0U, 7U, 250U}) {
    const std::string file = pipe("slow.jsonl");
    HeldPipe slow(file);
    Process process = with_own_clock(run(scene, {"--replay", file, "--record", again}));
    for (std::size_t i = 0; i <= ticks; ++i) slow.write(lines[i] + '\n');
    slow.write(lines[ticks + 1].substr(0, 49));
    slow.await_empty(process);
    // The process reads on when it has replayed all ticks that it read before.
    slow.write(lines[ticks + 1].substr(49, 1));  // and the rest does not come
    slow.await_empty(process);
    process.signal(SIGINT);
    process.signal(SIGINT);
    const CommandResult result = process.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "replayed " + std::to_string(ticks) + " ticks\n");
    EXPECT_EQ(ticks_in(file_content(again), false), ticks);
    EXPECT_EQ(unfinished_bytes(), 0u);
    std::filesystem::remove(file);
    std::filesystem::remove(again);
  }
}

// Amid a replay that does not wait for anything. If the replay ended before it heard the signals,
// the next one is twice as long.
TEST_F(RunSignals, KeepWhatWasReplayed) {
  const std::string scene = boxes(), whole = path("whole.jsonl"), again = path("again.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "2", "--record", whole}));
  const std::string recorded = file_content(whole);
  const std::size_t first = recorded.find('\n') + 1;  // below the header
  std::size_t bytes = 20 << 20;
  const auto lengthen = [&] {
    std::string ticks = recorded.substr(0, first);
    while (ticks.size() < bytes) ticks += recorded.substr(first);
    write("whole.jsonl", ticks);
    bytes *= 2;
    return lines_of(ticks).size() - 1;
  };
  std::size_t all = lengthen();
  int interrupted = 0;
  for (int round = 0; round < 8 && interrupted < 4; ++round) {
    Process process = with_own_clock(run(scene, {"--replay", whole, "--record", again}));
    await_ticks(process);
    process.signal(SIGTERM);
    process.signal(SIGINT);
    const CommandResult result = process.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t replayed = lines_of(file_content(again)).size() - 1;  // below the header
    EXPECT_EQ(result.err, "replayed " + std::to_string(replayed) + " ticks\n");
    EXPECT_GT(replayed, 50u);
    EXPECT_LE(replayed, all);
    EXPECT_TRUE(file_content(again).ends_with("}\n"));
    std::filesystem::remove(again);
    if (replayed < all) {
      ++interrupted;
    } else {
      all = lengthen();
    }
  }
  EXPECT_EQ(interrupted, 4);
}

}  // namespace
}  // namespace ist::test
