// Signals that end the command: it dies by them, and leaves nothing half-written.

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>
#include <utility>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/stability.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

class Interruption : public CliTest {
 protected:
  Interruption() { leave_no_core(); }
  // A tree that queries do not warn of.
  [[nodiscard]] std::string fine_tree() const {
    static_cast<void>(smaller_fine_tree());
    return ball_tree("ball.ist", "tight", {"--voxel-size", "0.05"});
  }
  // A query that goes on for minutes, and writes its contacts into the folder all the while.
  // No note comes before the progress bar.
  [[nodiscard]] std::vector<std::string> long_query(const std::string& tree) const {
    return {"approach", tree,         path("smaller.ist"),
            "--axis",   "z",          "--from",
            "0",        "--to",       "1",
            "--step",   "0.01",       "--repeat",
            "1000000",  "--contacts", path("c.jsonl")};
  }
};

TEST_F(Interruption, OfAQueryLeavesNoContacts) {
  StabilityCase seen("faults", "signal in a query", "wrong outcomes");
  const std::string tree = fine_tree();
  const std::string leaf_pairs = write("c.jsonl", "older");
  const std::size_t entries = dir_.entries();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    Process process(IST_COMMAND, long_query(tree));
    await_entries(entries + 1, process);
    process.signal(signal);
    const CommandResult result = process.wait();
    const bool clean = result.exit_code == 128 + signal && result.out.empty() &&
                       without_notes(result.err).empty() && dir_.entries() == entries &&
                       file_content(leaf_pairs) == "older";
    seen.sample(!clean, 0, std::to_string(result.exit_code) + ": " + result.err);
  }
}

TEST_F(Interruption, OfABuildLeavesTheOlderTree) {
  IST_SLOW();
  StabilityCase seen("faults", "SIGINT and SIGQUIT in a build", "wrong outcomes");
  const std::string ball = mesh("fine.stl", icosphere(4, 2)), tree = path("out.ist");
  const std::vector<std::string> build{"build", ball, "-o", tree, "--voxel-size", "0.02"};
  ist_well(build);
  const std::string whole = file_content(tree);
  int early = 0;
  // Returns whether the older tree is left.
  const auto interrupt = [&](Process& process, int signal, std::size_t entries) {
    process.signal(signal);
    const CommandResult result = process.wait();
    const bool ended = result.exit_code == 128 + signal;
    // The signal may also come when all is written, and only the end of the process is not there.
    const bool older = file_content(tree) == "older";
    const bool clean = dir_.entries() == entries && (older ? ended : file_content(tree) == whole) &&
                       (ended || result.exit_code == 0);
    seen.sample(!clean, 0, std::to_string(result.exit_code) + ": " + result.err);
    return older;
  };
  // At any moment, until one comes before the tree is written.
  for (int round = 0; round < 8 || early == 0; ++round) {
    dir_.write("out.ist", "older");
    const std::size_t entries = dir_.entries();
    Process process(IST_COMMAND, build);
    std::this_thread::sleep_for(20ms * (round % 8));
    const bool half = dir_.entries() > entries;
    if (interrupt(process, SIGINT, entries) && !half) ++early;
  }
  for (const int signal : {SIGINT, SIGQUIT}) {
    dir_.write("out.ist", "older");
    const std::size_t entries = dir_.entries();
    for (int round = 0; round < 3; ++round) {  // while it is written, or later
      dir_.write("out.ist", "older");
      Process process(IST_COMMAND, build);
      await_entries(entries + 1, process);
      interrupt(process, signal, entries);
    }
    // It is written, and waits for the disk.
    dir_.write("out.ist", "older");
    Process process = with_held_call("fsync", 0, build);
    await_hold(process);
    EXPECT_EQ(dir_.entries(), entries + 1);
    EXPECT_TRUE(interrupt(process, signal, entries)) << signal;
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

// The line of a status of the system that begins with `key`, without it.
std::string status_line(const std::filesystem::path& status, const std::string& key) {
  std::istringstream lines(file_content(status));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key)) return line.substr(key.size());
  }
  return "";
}

// The system drops a signal that a process ignores. Other signals wait while the process is
// stopped.
TEST_F(Interruption, LeavesIgnoredSignalsIgnored) {
  const std::string tree = fine_tree(), id = write("id", "");
  const std::size_t entries = dir_.entries();
  std::vector<std::string> arguments = long_query(tree);
  arguments.insert(arguments.begin(),
                   {"-c", "trap '' INT QUIT; echo $$ >\"$0\"; exec \"$@\"", id, IST_COMMAND});
  Process process("/bin/sh", arguments);
  await_entries(entries + 1, process);
  const std::filesystem::path system = "/proc/" + std::to_string(std::stoi(file_content(id)));
  const auto signals = [&](const char* key) {
    return std::stoull(status_line(system / "status", key), nullptr, 16);
  };
  constexpr std::uint64_t kBoth = 1U << (SIGINT - 1) | 1U << (SIGQUIT - 1);
  do {  // until it stops where it blocks no signal: a blocked one waits, also if it is ignored
    process.signal(SIGCONT);
    process.signal(SIGSTOP);
    await(process, [&] {
      bool stopped = true;
      for (const auto& thread : std::filesystem::directory_iterator(system / "task")) {
        stopped = stopped && says(status_line(thread.path() / "status", "State:"), "stopped");
      }
      return stopped;
    });
  } while ((signals("SigBlk:") & kBoth) != 0);
  process.signal(SIGINT);
  process.signal(SIGQUIT);
  EXPECT_EQ(signals("ShdPnd:"), 0u);
  process.signal(SIGTERM);
  EXPECT_NE(signals("ShdPnd:"), 0u);
  process.signal(SIGCONT);
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
    user_ = ::open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    EXPECT_GE(user_, 0);
  }
  ~Terminal() {
    if (user_ >= 0) ::close(user_);
    ::close(descriptor_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Stops it, as Ctrl-S does, or lets it go on.
  void stop(bool stops) const { ASSERT_EQ(::tcflow(user_, stops ? TCOOFF : TCOON), 0); }
  // Reads until the programs on it have ended.
  void await_end() {
    ::close(user_);
    user_ = -1;
    char text[256];
    for (ssize_t got; (got = ::read(descriptor_, text, sizeof text)) > 0;) {
      shown.append(text, static_cast<std::size_t>(got));
    }
  }

  std::string name, shown;

 private:
  int descriptor_, user_ = -1;
};

// The bar stands still after its first drawing, or after its third.
TEST_F(Interruption, ClearsTheProgressBar) {
  IST_SLOW();
  const std::string tree = fine_tree();
  for (const auto& [signal, waits] : {std::pair(SIGINT, 0), {SIGQUIT, 2}}) {
    Terminal terminal;
    Process process =
        with_held_call("pthread_cond_clockwait", waits, long_query(tree), terminal.name);
    await_hold(process);
    process.signal(signal);
    EXPECT_EQ(process.wait().exit_code, 128 + signal);
    terminal.await_end();
    EXPECT_TRUE(terminal.shown.ends_with("asking\r\033[K")) << terminal.shown;
  }
}

// The percentages that a terminal has shown, in order.
std::vector<int> percentages(const std::string& shown) {
  std::vector<int> numbers;
  for (std::size_t at = 0; (at = shown.find("] ", at)) != std::string::npos; ++at) {
    numbers.push_back(std::atoi(shown.c_str() + at + 1));
  }
  return numbers;
}

TEST_F(Interruption, LongWorkHasOneProgressBarThatOnlyGrows) {
  IST_SLOW();
  const std::string body = ball();
  const std::vector<std::vector<std::string>> commands = {
      {"advise", body, body, "--budget-us", "300"},
      {"bench", body, body, "--voxel-size", "0.5", "--seconds", "3"}};
  for (const std::vector<std::string>& words : commands) {
    Terminal terminal;
    Process process = with_told_call("fputs", 0, words, terminal.name);
    await_hold(process);
    EXPECT_EQ(process.wait().exit_code, 0) << words[0];
    terminal.await_end();
    const std::vector<int> parts = percentages(terminal.shown);
    EXPECT_FALSE(parts.empty()) << words[0];
    EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end())) << terminal.shown;
  }
}

// With a bar that was drawn before, which cannot be cleared.
TEST_F(Interruption, DoesNotWaitForATerminalThatIsStopped) {
  IST_SLOW();
  const std::string tree = fine_tree();
  const std::size_t entries = dir_.entries();
  Terminal terminal;
  Process process = with_held_call("pthread_cond_clockwait", 0, long_query(tree), terminal.name);
  await_hold(process);
  terminal.stop(true);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  terminal.stop(false);
  EXPECT_EQ(dir_.entries(), entries);
}

// The thread that draws waits for the terminal, and holds the lock of the bar.
TEST_F(Interruption, DoesNotWaitForABarThatWaitsForAStoppedTerminal) {
  IST_SLOW();
  const std::string tree = fine_tree();
  const std::size_t entries = dir_.entries();
  Terminal terminal;
  terminal.stop(true);
  Process process = with_told_call("fputs", 0, long_query(tree), terminal.name);
  await_hold(process);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  terminal.stop(false);
  EXPECT_EQ(dir_.entries(), entries);
}

}  // namespace
}  // namespace ist::test
