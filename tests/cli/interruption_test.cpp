// Signals that end the command: it dies by them, and leaves nothing half-written.

#include <fcntl.h>
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
  // A query that goes on for minutes, and writes its contacts into the folder all the while.
  [[nodiscard]] std::vector<std::string> long_query(const std::string& tree) const {
    return {"approach", tree,     tree,   "--axis",   "z",       "--from",     "0",      "--to",
            "1",        "--step", "0.01", "--repeat", "1000000", "--contacts", path("c")};
  }
  // Waits until it holds so many entries, or the process has ended.
  void await_entries(std::size_t entries, Process& process) const {
    while (dir_.entries() < entries && process.is_running()) std::this_thread::sleep_for(100us);
  }
};

TEST_F(Interruption, OfAQueryLeavesNoContacts) {
  StabilityCase seen("faults", "signal in a query", "wrong outcomes");
  const std::string tree = ball_tree("ball.ist", "tight", {"--voxel-size", "0.05"});
  const std::string leaf_pairs = write("c", "older");
  const std::size_t entries = dir_.entries();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
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
  StabilityCase seen("faults", "SIGINT in a build", "wrong outcomes");
  const std::string ball = mesh("fine.stl", icosphere(4, 2)), tree = path("out.ist");
  const std::vector<std::string> build{"build", ball, "-o", tree, "--voxel-size", "0.02"};
  ist_well(build);
  const std::string whole = file_content(tree);
  int early = 0, while_written = 0;
  const auto interrupt = [&](auto&& await) {
    dir_.write("out.ist", "older");
    const std::size_t entries = dir_.entries();
    Process process(IST_COMMAND, build);
    await(process, entries);
    const bool half = dir_.entries() > entries;
    process.signal(SIGINT);
    const CommandResult result = process.wait();
    const bool ended = result.exit_code == 128 + SIGINT;
    // The signal may also come when all is written, and only the end of the process is not there.
    const bool older = file_content(tree) == "older";
    const bool clean = dir_.entries() == entries && (older ? ended : file_content(tree) == whole) &&
                       (ended || result.exit_code == 0);
    seen.sample(!clean, 0, std::to_string(result.exit_code) + ": " + result.err);
    if (older) ++(half ? while_written : early);
  };
  for (int tenth = 0; tenth < 8; ++tenth) {
    interrupt([&](Process&, std::size_t) { std::this_thread::sleep_for(20ms * tenth); });
  }
  for (int i = 0; i < 20 && while_written == 0; ++i) {
    interrupt([&](Process& process, std::size_t entries) { await_entries(entries + 1, process); });
  }
  EXPECT_GT(early, 0);
  EXPECT_GT(while_written, 0);
}

TEST_F(Interruption, LeavesAnIgnoredSignalIgnored) {
  const std::string tree = ball_tree();
  const std::size_t entries = dir_.entries();
  std::vector<std::string> arguments = long_query(tree);
  arguments.insert(arguments.begin(), {"-c", "trap '' INT; exec \"$@\"", "sh", IST_COMMAND});
  Process process("/bin/sh", arguments);
  await_entries(entries + 1, process);
  process.signal(SIGINT);
  std::this_thread::sleep_for(50ms);
  EXPECT_TRUE(process.is_running());
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGTERM);
  EXPECT_EQ(dir_.entries(), entries);
}

TEST_F(Interruption, ClearsTheProgressBar) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(::grantpt(terminal), 0);
  ASSERT_EQ(::unlockpt(terminal), 0);
  Process process(IST_COMMAND, long_query(ball_tree()), ::ptsname(terminal));
  std::string shown;
  char text[256];
  while (!shown.ends_with("asking")) {
    const ssize_t got = ::read(terminal, text, sizeof text);
    ASSERT_GT(got, 0) << shown;
    shown.append(text, static_cast<std::size_t>(got));
  }
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 128 + SIGINT);
  for (ssize_t got; (got = ::read(terminal, text, sizeof text)) > 0;) {
    shown.append(text, static_cast<std::size_t>(got));
  }
  ::close(terminal);
  EXPECT_TRUE(shown.ends_with("asking\r\033[K")) << shown;
}

}  // namespace
}  // namespace ist::test
