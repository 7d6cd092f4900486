// A later signal to `ist run`: the process is gone within 1 s, with a recording that is whole.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "cli/run_signals_case.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

// Later than the 1 s within which signals are the same one, also where the command is slow to run.
constexpr auto kLater = 1500ms;

class RunLaterSignal : public RunSignals {};

TEST_F(RunLaterSignal, WaitsForTheRecording) {
  const std::string file = pipe("ticks.jsonl");
  HeldPipe slow(file);
  Process process(IST_COMMAND, endless_paced(file));
  slow.await(true);
  std::this_thread::sleep_for(300ms);
  process.signal(SIGINT);
  std::this_thread::sleep_for(kLater);
  EXPECT_TRUE(process.is_running());
  process.signal(SIGTERM);
  std::this_thread::sleep_for(200ms);  // less than it waits for
  const std::string text = slow.read_to_the_end_of(process);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGTERM);
  EXPECT_GT(ticks_in(text, true), 150u) << "more than the pipe held";
}

TEST_F(RunLaterSignal, DoesNotWaitForTheLoop) {
  const std::string file = path("ticks.jsonl");
  for (const int signal : {SIGINT, SIGHUP}) {
    Process process = with_held_call("clock_nanosleep", 300, endless_paced(file));
    await_hold(process);
    process.signal(signal);
    std::this_thread::sleep_for(kLater);
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
  process.signal(SIGINT);
  await_hold(process);
  std::this_thread::sleep_for(kLater);
  EXPECT_TRUE(process.is_running());
  EXPECT_EQ(file_content(file), "older");
  expect_end_by(SIGINT, process);
  EXPECT_GT(ticks_in(file_content(file), false), 50u);
  EXPECT_EQ(unfinished_bytes(), 0u);
}

TEST_F(RunLaterSignal, DoesNotWaitForTheReport) {
  const std::string file = path("ticks.jsonl"), out = pipe("out");
  HeldPipe full(out);
  full.fill();
  std::vector<std::string> arguments = endless_paced(file);
  arguments.insert(arguments.begin(), {"-c", "exec \"$@\" >\"$0\"", out, IST_COMMAND});
  Process process("/bin/sh", arguments);
  await_ticks(process);
  process.signal(SIGINT);
  std::this_thread::sleep_for(kLater);
  EXPECT_TRUE(process.is_running());
  expect_end_by(SIGINT, process);
  EXPECT_GT(ticks_in(file_content(file), true), 50u);
}

TEST_F(RunLaterSignal, DoesNotWaitForADiskThatHangs) {
  const std::string file = pipe("ticks.jsonl");
  const HeldPipe hangs(file);
  Process process(IST_COMMAND, endless(file, {"--unpaced"}));
  hangs.await(true);
  process.signal(SIGINT);
  std::this_thread::sleep_for(kLater);
  EXPECT_TRUE(process.is_running());
  expect_end_by(SIGINT, process);
}

}  // namespace
}  // namespace ist::test
