// Signals that end the command: it dies by them, and leaves nothing half-written.

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

class Interruption : public CliTest {
 protected:
  Interruption() { leave_no_core(); }
  // A query that goes on for minutes, and writes its contacts into the folder all the while.
  [[nodiscard]] std::vector<std::string> long_query(const std::string& tree) const {
    return {"approach", tree,       tree,      "--axis",     "z",
            "--from",   "0",        "--to",    "1",          "--step",
            "0.01",     "--repeat", "1000000", "--contacts", path("c.jsonl")};
  }
};

TEST_F(Interruption, OfAQueryLeavesNoContacts) {
  StabilityCase seen("faults", "signal in a query", "wrong outcomes");
  const std::string tree = ball_tree("ball.ist", "tight", {"--voxel-size", "0.05"});
  const std::string leaf_pairs = write("c.jsonl", "older");
  const std::size_t entries = dir_.entries();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    Process process(IST_COMMAND, long_query(tree));
    await_entries(entries + 1, process);
    process.signal(signal);
    const CommandResult result = process.wait();
    const bool clean = result.exit_code == 128 + signal && result.out.empty() &&
                       result.err.empty() && dir_.entries() == entries &&
                       file_content(leaf_pairs) == "older";
    seen.sample(!clean, 0, std::to_string(result.exit_code) + ": " + result.err);
  }
}

TEST_F(Interruption, OfABuildLeavesTheOlderTree) {
  StabilityCase seen("faults", "SIGINT and SIGQUIT in a build", "wrong outcomes");
  const std::string ball = mesh("fine.stl", icosphere(4, 2)), tree = path("out.ist");
  const std::vector<std::string> build{"build", ball, "-o", tree, "--voxel-size", "0.02"};
  ist_well(build);
  const std::string whole = file_content(tree);
  int early = 0, while_written = 0;
  const auto interrupt = [&](int signal, auto&& await) {
    dir_.write("out.ist", "older");
    const std::size_t entries = dir_.entries();
    Process process(IST_COMMAND, build);
    await(process, entries);
    const bool half = dir_.entries() > entries;
    process.signal(signal);
    const CommandResult result = process.wait();
    const bool ended = result.exit_code == 128 + signal;
    // The signal may also come when all is written, and only the end of the process is not there.
    const bool older = file_content(tree) == "older";
    const bool clean = dir_.entries() == entries && (older ? ended : file_content(tree) == whole) &&
                       (ended || result.exit_code == 0);
    seen.sample(!clean, 0, std::to_string(result.exit_code) + ": " + result.err);
    if (older) ++(half ? while_written : early);
  };
  for (int tenth = 0; tenth < 8; ++tenth) {
    interrupt(SIGINT, [&](Process&, std::size_t) { std::this_thread::sleep_for(20ms * tenth); });
  }
  EXPECT_GT(early, 0);
  for (const int signal : {SIGINT, SIGQUIT}) {
    while_written = 0;
    for (int i = 0; i < 20 && while_written == 0; ++i) {
      interrupt(signal, [&](Process& process, std::size_t entries) {
        await_entries(entries + 1, process);
      });
    }
    EXPECT_GT(while_written, 0) << signal;
  }
}

// All files appear together, or none: one is stored on the disk, and the other waits for it.
TEST_F(Interruption, OfAnOcclusionLeavesAllOlderFiles) {
  const std::string body = ball(), table = write("b.csv", "older"), map = path("b.vtp");
  const std::size_t entries = dir_.entries();
  for (const int signal : {SIGINT, SIGQUIT}) {
    Process process = with_held_call(
        "fsync", 1, {"occlusion", body, body, "--move", "3.9,0,0", "-o", table, "-o", map});
    await_hold(process);
    process.signal(signal);
    EXPECT_EQ(process.wait().exit_code, 128 + signal);
    EXPECT_EQ(file_content(table), "older");
    EXPECT_EQ(dir_.entries(), entries);
  }
}

TEST_F(Interruption, LeavesIgnoredSignalsIgnored) {
  const std::string tree = ball_tree();
  const std::size_t entries = dir_.entries();
  std::vector<std::string> arguments = long_query(tree);
  arguments.insert(arguments.begin(), {"-c", "trap '' INT QUIT; exec \"$@\"", "sh", IST_COMMAND});
  Process process("/bin/sh", arguments);
  await_entries(entries + 1, process);
  process.signal(SIGINT);
  process.signal(SIGQUIT);
  std::this_thread::sleep_for(50ms);
  EXPECT_TRUE(process.is_running());
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGTERM);
  EXPECT_EQ(dir_.entries(), entries);
}

// A terminal, and what a program shows on it.
class Terminal {
 public:
  Terminal() : descriptor_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_EQ(::grantpt(descriptor_), 0);
    EXPECT_EQ(::unlockpt(descriptor_), 0);
    name = ::ptsname(descriptor_);
  }
  ~Terminal() { ::close(descriptor_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Reads until that is shown, or the programs on it have ended.
  void await(const std::string& end) {
    char text[256];
    while (end.empty() || !shown.ends_with(end)) {
      const ssize_t got = ::read(descriptor_, text, sizeof text);
      if (got <= 0) return;
      shown.append(text, static_cast<std::size_t>(got));
    }
  }

  std::string name, shown;

 private:
  int descriptor_;
};

TEST_F(Interruption, ClearsTheProgressBar) {
  for (const int signal : {SIGINT, SIGQUIT}) {
    Terminal terminal;
    Process process(IST_COMMAND, long_query(ball_tree()), terminal.name);
    terminal.await("asking");
    process.signal(signal);
    EXPECT_EQ(process.wait().exit_code, 128 + signal);
    terminal.await("");
    EXPECT_TRUE(terminal.shown.ends_with("asking\r\033[K")) << terminal.shown;
  }
}

TEST_F(Interruption, DoesNotWaitForATerminalThatIsStopped) {
  const std::string tree = ball_tree();
  const std::size_t entries = dir_.entries();
  Terminal terminal;
  const int user = ::open(terminal.name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(user, 0);
  Process process(IST_COMMAND, long_query(tree), terminal.name);
  terminal.await("asking");
  ASSERT_EQ(::tcflow(user, TCOOFF), 0);  // as Ctrl-S does
  std::this_thread::sleep_for(500ms);    // the bar is drawn ten times a second
  process.signal(SIGINT);
  for (int i = 0; i < 3000 && process.is_running(); ++i) std::this_thread::sleep_for(1ms);
  EXPECT_FALSE(process.is_running());
  ASSERT_EQ(::tcflow(user, TCOON), 0);
  ::close(user);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  EXPECT_EQ(dir_.entries(), entries);
}

}  // namespace
}  // namespace ist::test
