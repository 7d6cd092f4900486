// Signals to `ist run`: the first ends it in order, with a recording that is whole.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <utility>

#include "cli/run_signals_case.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

TEST_F(RunSignals, TwoAtOnceAreOne) {
  const std::string file = path("ticks.jsonl");
  const std::pair<int, int> pairs[] = {{SIGINT, SIGINT}, {SIGINT, SIGTERM}, {SIGHUP, SIGINT}};
  for (int round = 0; round < 4; ++round) {
    for (const auto& [first, second] : pairs) {
      const bool paced = round % 2 == 1;
      Process process(IST_COMMAND, paced ? endless_paced(file) : endless(file, {"--unpaced"}));
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
    Process process(IST_COMMAND, endless_paced(file));
    slow.await(true);
    std::this_thread::sleep_for(300ms);  // the pipe is full, and the disk does not take the rest
    process.signal(SIGINT);
    std::this_thread::sleep_for(200ms);
    process.signal(SIGINT);
    std::this_thread::sleep_for(100ms);
    EXPECT_TRUE(process.is_running());
    const std::string text = slow.read_to_the_end_of(process);
    expect_order(process.wait(), text, true);
    std::filesystem::remove(file);
  }
}

// It signals the process, and then its group.
TEST_F(RunSignals, OfTimeoutEndARunInOrder) {
  const std::string file = path("ticks.jsonl");
  for (int round = 0; round < 4; ++round) {
    std::vector<std::string> arguments = endless_paced(file);
    arguments.insert(arguments.begin(), {"-s", "INT", "1.5", IST_COMMAND});
    CommandResult result = run_command("/usr/bin/timeout", arguments);
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
  for (int round = 0; round < 6; ++round) {
    const std::vector<std::string> arguments = endless(file, {"--unpaced"});
    const std::size_t entries = dir_.entries();
    Process process(IST_COMMAND, arguments);
    await_ticks(process);
    if (round % 2 == 1) process.signal(SIGINT);  // and while it ends in order, if it still runs
    process.signal(SIGQUIT);
    const CommandResult result = process.wait();
    EXPECT_EQ(unfinished_bytes(), 0u);
    if (result.exit_code == 0) {
      expect_order(result, file_content(file), false);
      std::filesystem::remove(file);
    } else {
      EXPECT_EQ(result.exit_code, 128 + SIGQUIT);
    }
    EXPECT_EQ(dir_.entries(), entries);
  }
}

TEST_F(RunSignals, EndARunAtOnceThatWaitsForAReader) {
  const std::string file = pipe("ticks.jsonl");
  Process process(IST_COMMAND, endless(file, {"--unpaced"}));
  std::this_thread::sleep_for(300ms);
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
    Process process(IST_COMMAND, run(scene, {"--replay", file, "--record", again}));
    for (std::size_t i = 0; i <= ticks; ++i) slow.write(lines[i] + '\n');
    slow.write(lines[ticks + 1].substr(0, 50));  // and the rest does not come
    slow.await(false);
    std::this_thread::sleep_for(300ms);
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

// Amid a replay that does not wait for anything.
TEST_F(RunSignals, KeepWhatWasReplayed) {
  const std::string scene = boxes(), whole = path("whole.jsonl"), again = path("again.jsonl");
  std::string ticks;
  ist_well(run(scene, {"--unpaced", "--seconds", "2", "--record", whole}));
  const std::string recorded = file_content(whole);
  const std::size_t first = recorded.find('\n') + 1;  // below the header
  ticks = recorded.substr(0, first);
  while (ticks.size() < (20 << 20)) ticks += recorded.substr(first);
  write("whole.jsonl", ticks);
  for (int round = 0; round < 4; ++round) {
    Process process(IST_COMMAND, run(scene, {"--replay", whole, "--record", again}));
    await_ticks(process);
    process.signal(SIGTERM);
    process.signal(SIGINT);
    const CommandResult result = process.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t replayed = lines_of(file_content(again)).size() - 1;  // below the header
    EXPECT_EQ(result.err, "replayed " + std::to_string(replayed) + " ticks\n");
    EXPECT_GT(replayed, 50u);
    EXPECT_LT(replayed, lines_of(ticks).size());
    EXPECT_TRUE(file_content(again).ends_with("}\n"));
    std::filesystem::remove(again);
  }
}

}  // namespace
}  // namespace ist::test
