#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/run_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

/// A test that sends signals to a run which records.
class RunSignals : public RunCase {
 protected:
  RunSignals() { leave_no_core(); }

  /// A run that does not end by itself.
  [[nodiscard]] std::vector<std::string> endless(const std::string& record,
                                                 std::vector<std::string> more = {}) const {
    const std::string scene = write("endless.toml",
                                    "unit = \"mm\"\n[fixed]\nshape = \"box\"\nsize = [8, 8, 4]\n"
                                    "voxel_size = 1\n[held]\nshape = \"box\"\nsize = [4, 4, 4]\n"
                                    "voxel_size = 1\ntranslation = [0, 0, 5]\n"
                                    "[device]\nkind = \"null\"\n[effects.springs]\n");
    more.insert(more.end(), {"--seconds", "100000", "--json", "--record", record});
    return run(scene, more);
  }
  [[nodiscard]] std::vector<std::string> endless_paced(const std::string& record) const {
    return endless(record, {"--allow-missed", "100000000"});
  }
  /// How many bytes of recordings that are not whole yet lie in the folder.
  [[nodiscard]] std::uintmax_t unfinished_bytes() const {
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path())) {
      std::error_code gone;
      const std::uintmax_t size = std::filesystem::file_size(entry, gone);
      if (entry.path().extension() == ".tmp" && !gone) bytes += size;
    }
    return bytes;
  }
  /// Waits until ticks are written, so that a signal comes amid the run.
  void await_ticks(Process& process) const {
    await(process, [&] { return unfinished_bytes() > 0; });
  }
  [[nodiscard]] std::string pipe(const std::string& name) const {
    const std::string file = path(name);
    EXPECT_EQ(::mkfifo(file.c_str(), 0600), 0);
    return file;
  }

  /// The number of ticks in a recording, whose lines are ticks that follow each other; the clock
  /// may have left some out.
  static std::size_t ticks_in(const std::string& text, bool paced) {
    EXPECT_TRUE(text.empty() || text.ends_with("}\n"));
    const std::vector<nlohmann::json> lines = json_lines(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto tick = lines[i]["tick"].get<std::size_t>();
      const std::size_t least = i == 0 ? 0 : lines[i - 1]["tick"].get<std::size_t>() + 1;
      if (paced ? tick < least : tick != i) {
        ADD_FAILURE() << "tick " << tick << " in line " << i;
        return 0;
      }
    }
    return lines.size();
  }
  /// A run that a signal ended in order: it reports, and its recording has the ticks reported.
  static void expect_order(const CommandResult& result, const std::string& text, bool paced) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = json_lines(result.out);
    ASSERT_EQ(report.size(), 1u) << "no report";
    EXPECT_EQ(report[0]["ticks"], ticks_in(text, paced));
    EXPECT_GT(report[0]["ticks"], 0);
  }
  /// Sends a signal, and expects that it ends the process. The process may take as long as the
  /// machine needs: nothing else would end it.
  static void expect_end_by(int signal, Process& process) {
    process.signal(signal);
    EXPECT_EQ(process.wait().exit_code, 128 + signal);
  }
};

/// A pipe with both ends held by a test, so that nobody waits to open it. It holds one page, less
/// than a recording writes at a time.
class HeldPipe {
 public:
  explicit HeldPipe(const std::string& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)),
        capacity_(::fcntl(descriptor_, F_SETPIPE_SZ, 1)) {
    EXPECT_GE(descriptor_, 0);
    EXPECT_GT(capacity_, 0);
  }
  ~HeldPipe() { ::close(descriptor_); }
  HeldPipe(const HeldPipe&) = delete;
  HeldPipe& operator=(const HeldPipe&) = delete;

  /// Waits until a writer waits for room in the pipe, or a reader for more of it. Returns too when
  /// the process has ended.
  void await_full(Process& process) const { await_bytes(capacity_, process); }
  void await_empty(Process& process) const { await_bytes(0, process); }
  void fill() {
    const std::string bytes(static_cast<std::size_t>(capacity_), ' ');
    EXPECT_EQ(::write(descriptor_, bytes.data(), bytes.size()), capacity_);
  }
  void write(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
      if (written > 0) done += static_cast<std::size_t>(written);
      if (written < 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// Returns the bytes that the process writes until it ends.
  std::string read_to_the_end_of(Process& process) {
    std::string text;
    std::vector<char> bytes(1 << 16);
    for (bool running = true; running;) {
      running = process.is_running();
      for (ssize_t got; (got = ::read(descriptor_, bytes.data(), bytes.size())) > 0;) {
        text.append(bytes.data(), static_cast<std::size_t>(got));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return text;
  }

 private:
  void await_bytes(int wanted, Process& process) const {
    for (int bytes = -1; bytes != wanted && process.is_running();) {
      ASSERT_EQ(::ioctl(descriptor_, FIONREAD, &bytes), 0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  int descriptor_, capacity_;
};

// Signals to `ist run`: the first ends it in order, with a recording that is whole.

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

    // While the run ends in order, its recording is stored, but has no name yet.
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

// A later signal to `ist run`: the process ends within 1 s, and its recording is whole. The clock
// is the test's. The later signal comes 1 s after the first, and waits for the recording until 1.8
// s.

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
