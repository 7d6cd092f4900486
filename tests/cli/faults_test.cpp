// What surroundings can do to the command: a disk that is full, a folder that is read only, memory
// that ends, files that change. Each ends in an error that helps, and leaves nothing half-written.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>

#include "cli/cli_case.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/stability.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

class Faults : public CliTest {
 protected:
  // Everything in the folder, by name.
  [[nodiscard]] std::map<std::string, std::string> folder() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path())) {
      files[entry.path().filename()] = file_content(entry.path());
    }
    return files;
  }
  // A tree that queries do not warn of.
  [[nodiscard]] std::string fine_tree() const {
    return ball_tree("ball.ist", "tight", {"--voxel-size", "0.05"});
  }
  // Runs it behind a command of the shell that takes the rest as its arguments.
  static CommandResult ist_behind(const std::string& prefix, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-c", prefix + " \"$@\"", "sh", IST_COMMAND});
    return run_command("/bin/sh", arguments);
  }
};

std::string cannot(const std::string& doing, const std::string& file, const std::string& cause) {
  return "ist: " + file + ": cannot " + doing + " the file: " + cause +
         ": check the folder, its permissions and the space on the disk [file-unwritable]\n";
}

// Everything that writes a file, with its name last.
std::vector<std::vector<std::string>> writers(const std::string& mesh, const std::string& tree) {
  return {{"build", mesh, "--voxel-size", "0.05", "-o"},
          {"export", tree, "--what", "voxels", "--level", "0", "-o"},
          {"approach", tree, tree, "--axis", "z", "--from", "0", "--to", "2", "--step", "0.5",
           "--contacts"}};
}

TEST_F(Faults, ADiskThatFillsUpLeavesTheOlderFile) {
  IST_SLOW();
  StabilityCase seen("faults", "disk full", "wrong outcomes");
  const std::string mesh = ball(), tree = fine_tree(), target = write("target.ply", "older");
  const std::string device = path("device.ply");
  for (std::vector<std::string> command : writers(mesh, tree)) {
    command.push_back(target);
    const std::string full = cannot("write", target, "File too large");
    std::uintmax_t blocks = 1;  // of 512 bytes, as `ulimit -f` counts
    for (bool fits = false; !fits; blocks *= 8) {
      dir_.write("target.ply", "older");
      const auto before = folder();
      const CommandResult result =
          ist_behind("ulimit -f " + std::to_string(blocks) + " && exec", command);
      fits = result.exit_code == 0;
      const bool whole = file_content(target).size() > 512 && dir_.entries() == before.size();
      const bool refused =
          result.exit_code == 1 && without_notes(result.err) == full && folder() == before;
      seen.sample(fits ? !whole : !refused, 0, command[0] + ": " + result.err);
    }
    EXPECT_GT(blocks, 64u) << command[0] << " was never refused";

    std::filesystem::create_symlink("/dev/full", device);
    command.back() = device;
    const CommandResult result = ist(command);
    std::filesystem::remove(device);
    const bool told =
        result.exit_code == 1 &&
        without_notes(result.err) == cannot("write", device, "No space left on device");
    seen.sample(!told, 0, command[0] + ": " + result.err);
  }
}

// The folder has no room for the name of a file that is whole.
TEST_F(Faults, ADiskThatIsFullAtTheRenameLeavesTheOlderFile) {
  const std::string mesh = ball(), tree = fine_tree(), target = write("target.ply", "older");
  for (std::vector<std::string> command : writers(mesh, tree)) {
    command.push_back(target);
    const auto before = folder();
    const CommandResult result = with_failing_call("rename", 0, command);
    EXPECT_EQ(result.exit_code, 1) << command[0];
    EXPECT_TRUE(says(result.err, cannot("rename", target, "No space left on device")));
    EXPECT_EQ(folder(), before) << command[0];
  }
}

TEST_F(Faults, AReadOnlyFolderIsLeftAsItWas) {
  IST_SLOW();
  // Permissions do not bind root, unless it gives up what sets it above them.
  const std::string bound =
      ::geteuid() == 0 ? "exec setpriv --bounding-set -dac_override --" : "exec";
  if (run_command("/bin/sh", {"-c", bound + " true"}).exit_code != 0) {
    IST_SKIP("root may not give up its right to write everywhere");
  }
  StabilityCase seen("faults", "read-only folder", "wrong outcomes");
  const std::string mesh = ball(), tree = fine_tree(), older = write("older.ply", "older");
  const auto before = folder();
  ASSERT_EQ(::chmod(dir_.path().c_str(), 0555), 0);
  for (const std::string& target : {older, path("new.ply")}) {
    for (std::vector<std::string> command : writers(mesh, tree)) {
      command.push_back(target);
      const CommandResult result = ist_behind(bound, command);
      const bool told = result.exit_code == 1 && result.out.empty() &&
                        without_notes(result.err) == cannot("create", target, "Permission denied");
      seen.sample(!told || folder() != before, 0, command[0] + ": " + result.err);
    }
  }
  ASSERT_EQ(::chmod(dir_.path().c_str(), 0755), 0);
}

TEST_F(Faults, MemoryThatEndsIsNamedWithTheRemedy) {
  IST_SLOW();
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer takes terabytes of addresses";
#endif
  StabilityCase seen("faults", "memory limit", "wrong outcomes");
  const std::string ball = mesh("fine.stl", icosphere(5, 2)), tree = write("out.ist", "older");
  const auto before = folder();
  const std::vector<std::string> texts{
      "ist: out of memory: use a larger voxel size, or --max-memory\n",
      "ist: Resource temporarily unavailable: no memory for a thread, or too many of them: raise "
      "the limit (ulimit -v, -u)\n",
      "ist: pthread_create has failed: Resource temporarily unavailable: no memory for a thread, "
      "or too many of them: raise the limit (ulimit -v, -u)\n"};
  int refused = 0;
  constexpr int kFirst = 16, kLast = 4096;  // MiB
  for (int mib = kFirst; mib < kLast; mib += 1 + mib / 64) {
    const CommandResult result = ist_behind("ulimit -v " + std::to_string(mib * 1024) + " && exec",
                                            {"build", ball, "-o", tree, "--voxel-size", "0.05"});
    if (result.exit_code == 127) continue;  // not even its libraries could be loaded
    // Nor had the C++ runtime the 73 kB from which it makes exceptions when memory has ended.
    if (refused == 0 && result.err == "terminate called without an active exception\n") continue;
    if (result.exit_code == 0) {
      EXPECT_GT(read_tree(tree).leaf_count(), 1000u);
      EXPECT_EQ(dir_.entries(), before.size());
      EXPECT_GT(refused, 5);
      return;
    }
    const bool told =
        result.exit_code == 1 && result.out.empty() &&
        std::find(texts.begin(), texts.end(), without_notes(result.err)) != texts.end();
    seen.sample(!told || folder() != before, 0, std::to_string(mib) + " MiB: " + result.err);
    ++refused;
  }
  FAIL() << "it never has memory enough";
}

// Cuts a file again and again while it is read, and gives it back; what is read is it, or an error.
// Ends when the file was read whole and was cut, each at least once.
template <typename Read>
void expect_whole_or(const std::vector<std::string>& errors, const std::string& bytes,
                     const Read& is_read_well, StabilityCase& seen) {
  constexpr int kReads = 100;
  const MemoryFile file;
  file.write(bytes);
  std::map<std::string, int> outcomes;
  bool wrong = false;
  std::atomic<bool> stop = false;
  std::thread cutter([&] {
    for (std::size_t i = 0; !stop; ++i) {
      ::truncate(file.path().c_str(), static_cast<off_t>(i * 977 % bytes.size()));
      file.write(bytes);
      std::this_thread::sleep_for(std::chrono::microseconds(100));  // so that it is whole at times
    }
  });
  const auto both = [&] { return outcomes.size() > 1 && outcomes.contains("none"); };
  for (int reads = 0; reads < kReads || !both(); ++reads) {
    std::string outcome = error_name([&] { wrong = !is_read_well(file.path()); });
    if (outcome == "none" && wrong) outcome = "something else";
    const bool expected =
        outcome == "none" || std::find(errors.begin(), errors.end(), outcome) != errors.end();
    seen.sample(!expected, 0, outcome);
    ++outcomes[outcome];
  }
  stop = true;
  cutter.join();
}

TEST(CutFiles, AreReadWholeOrNotAtAll) {
  StabilityCase seen("faults", "file cut while read", "wrong outcomes");
  const TriangleMesh mesh = icosphere(4, 1);
  const auto all = corners(narrowed(mesh));
  const auto read = [&](const std::filesystem::path& file) {
    return corners(read_mesh(file)) == all;
  };
  const std::vector<std::string> cut{"mesh-truncated", "mesh-empty", "not-a-mesh"};
  expect_whole_or(cut, as_binary_stl(mesh), read, seen);
  expect_whole_or(cut, as_binary_ply(mesh, true), read, seen);
}

}  // namespace
}  // namespace ist::test
