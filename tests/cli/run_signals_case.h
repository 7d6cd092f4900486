#pragma once

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cli/run_case.h"

namespace ist::test {

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
                                    "[device]\nkind = \"null\"\n[effects.contact]\n");
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
  /// All that is written until the process has ended.
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

}  // namespace ist::test
