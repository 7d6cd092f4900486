// A later signal to `ist run`: the process is gone within 1 s, with a recording that is whole. The
// times are those of a clock of the test's. A later signal comes 1 s after the first, and waits for
// the recording until 1.8 s.

#include <csignal>
#include <filesystem>

#include "cli/run_signals_case.h"

namespace ist::test {
namespace {

class RunLaterSignal : public RunSignals {
 protected:
  /// Sends the first signal, and waits until the process has heard it and a second has passed.
  void begin_end(int signal, Process& process) const {
    process.signal(signal);
    await_heard(1, process);
    set_clock(1000);
  }
  /// Sends a later signal, and waits until the process waits for its recording.
  void end_when_recorded(int signal, Process& process) const {
    EXPECT_TRUE(process.is_running());
    process.signal(signal);
    await_heard(2, process);
    EXPECT_TRUE(waits_for_files());
    EXPECT_TRUE(process.is_running());
  }
};

TEST_F(RunLaterSignal, WaitsForTheRecording) {
  const std::string file = pipe("ticks.jsonl");
  HeldPipe slow(file);
  Process process = with_own_clock(endless_paced(file));
  slow.await_full(process);
  begin_end(SIGINT, process);
  end_when_recorded(SIGTERM, process);
  set_clock(1799);  // less than it waits for
  const std::string text = slow.read_to_the_end_of(process);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGTERM);
  EXPECT_GT(ticks_in(text, true), 50u) << "more than the pipe held";
}

TEST_F(RunLaterSignal, DoesNotWaitForTheLoop) {
  const std::string file = path("ticks.jsonl");
  for (const int signal : {SIGINT, SIGHUP}) {
    Process process = with_held_call("clock_nanosleep", 300, endless_paced(file));
    await_hold(process);
    begin_end(signal, process);
    EXPECT_TRUE(process.is_running());
    expect_end_by(signal, process);
    ASSERT_TRUE(exists("ticks.jsonl"));
    EXPECT_EQ(ticks_in(file_content(file), true), 301u);
    EXPECT_EQ(unfinished_bytes(), 0u);
    std::filesystem::remove(file);
  }
}

TEST_F(RunLaterSignal, DoesNotWaitForTheDiskToStore) {
  const std::string file = write("ticks.jsonl", "older");
  Process process = with_held_call("fsync", 0, endless(file, {"--unpaced"}));
  await_ticks(process);
  begin_end(SIGINT, process);
  await_hold(process);
  end_when_recorded(SIGINT, process);
  EXPECT_EQ(file_content(file), "older");
  set_clock(1800);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  EXPECT_GT(ticks_in(file_content(file), false), 50u);
  EXPECT_EQ(unfinished_bytes(), 0u);
}

TEST_F(RunLaterSignal, DoesNotWaitForTheReport) {
  const std::string file = path("ticks.jsonl"), out = pipe("out");
  HeldPipe full(out);
  full.fill();
  std::vector<std::string> arguments = words_with_own_clock(endless_paced(file));
  arguments.insert(arguments.begin(), {"-c", "exec \"$@\" >\"$0\"", out});
  Process process("/bin/sh", arguments);
  await_ticks(process);
  begin_end(SIGINT, process);
  await(process, [&] { return exists("ticks.jsonl"); });  // the report comes next
  EXPECT_TRUE(process.is_running());
  expect_end_by(SIGINT, process);
  EXPECT_GT(ticks_in(file_content(file), true), 50u);
}

TEST_F(RunLaterSignal, DoesNotWaitForADiskThatHangs) {
  const std::string file = pipe("ticks.jsonl");
  const HeldPipe hangs(file);
  Process process = with_own_clock(endless(file, {"--unpaced"}));
  hangs.await_full(process);
  begin_end(SIGINT, process);
  end_when_recorded(SIGINT, process);
  set_clock(1800);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
}

}  // namespace
}  // namespace ist::test
