#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "ist/mesh/mesh.h"
#include "support/run_command.h"
#include "support/temp_dir.h"

namespace ist::test {

/// A test of the command in a folder of its own, with small meshes in it.
class CliTest : public ::testing::Test {
 protected:
  static CommandResult ist(const std::vector<std::string>& arguments) {
    return run_command(IST_COMMAND, arguments);
  }
  /// Runs what must succeed.
  static CommandResult ist_well(const std::vector<std::string>& arguments);

  /// The path of a file in the folder, there or not.
  [[nodiscard]] std::string path(const std::string& name) const { return dir_.path() / name; }
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(dir_.path() / name);
  }
  std::string write(const std::string& name, const std::string& content) const {
    return dir_.write(name, content);
  }
  /// The lines of stderr that are no notes.
  static std::string without_notes(const std::string& err);
  /// Writes a mesh, and returns its path.
  [[nodiscard]] std::string mesh(const std::string& name, const TriangleMesh& mesh) const;
  /// A ball of radius 2 round the origin, closed and consistent.
  [[nodiscard]] std::string ball() const;
  /// Writes a closed needle of that length along x, and returns its path: few voxels fill it, also
  /// where they are small beside its extent.
  [[nodiscard]] std::string needle(const std::string& name, double length) const;
  /// A tree of the ball, at voxel size 0.5 unless `more` arguments of build name another.
  [[nodiscard]] std::string ball_tree(const std::string& name = "ball.ist",
                                      const std::string& spheres = "tight",
                                      const std::vector<std::string>& more = {}) const;
  /// A tree of a ball of radius 1.9 round the origin, at voxel size 0.05.
  [[nodiscard]] std::string smaller_fine_tree() const;
  /// Shifts along x as a file of poses.
  [[nodiscard]] std::string poses(const std::vector<double>& shifts) const;

  /// Processes that a signal ends leave no core from now on.
  static void leave_no_core();
  /// Waits until a condition holds, or the process has ended.
  template <typename Holds>
  static void await(Process& process, const Holds& holds) {
    while (!holds() && process.is_running()) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  /// Waits until the folder has that number of entries, or the process has ended.
  void await_entries(std::size_t entries, Process& process) const;

  // Calls of the command that a test holds, and the clock of its signals: support/held_calls.cpp.
  // They are of one process at a time.

  /// Starts the command, with stderr on a terminal if one is named. A call of it stands still after
  /// it has returned `after` times.
  [[nodiscard]] Process with_held_call(const std::string& call, int after,
                                       const std::vector<std::string>& arguments,
                                       const std::string& terminal = "") const;
  /// Starts the command. await_hold() waits until a call of it begins after it has returned `after`
  /// times.
  [[nodiscard]] Process with_told_call(const std::string& call, int after,
                                       const std::vector<std::string>& arguments,
                                       const std::string& terminal = "") const;
  /// Runs the command. A call of it fails after it has succeeded `after` times.
  [[nodiscard]] CommandResult with_failing_call(const std::string& call, int after,
                                                const std::vector<std::string>& arguments) const;
  /// Waits until the call stands still or is told.
  void await_hold(Process& process) const;
  /// Lets the call go on, if it stands still, and all later ones.
  void release() const;

  /// Starts the command. For the times between its signals it has a clock that begins at 0, and
  /// stands unless set_clock() sets it. Processes with a held call have this clock too.
  [[nodiscard]] Process with_own_clock(const std::vector<std::string>& arguments) const;
  /// Returns a command line that does the same.
  [[nodiscard]] std::vector<std::string> words_with_own_clock(
      const std::vector<std::string>& arguments) const;
  void set_clock(unsigned milliseconds) const;
  /// Waits until the command has heard that number of signals, and goes on or waits for its files.
  void await_heard(std::size_t signals, Process& process) const;
  /// Returns whether a signal is about to end the command, and waits for its files until then.
  [[nodiscard]] bool waits_for_files() const { return std::filesystem::exists(sign("waits")); }

  /// The lines of a text, each an object of JSON, without the header.
  static std::vector<nlohmann::json> json_lines(const std::string& text);

  const TempDir dir_;

 private:
  [[nodiscard]] std::filesystem::path sign(const std::string& name) const {
    return signs_.path() / name;
  }
  // Returns a command line, and forgets what an earlier process told.
  [[nodiscard]] std::vector<std::string> words_with_call(
      const std::string& call, int after, const std::string& how,
      const std::vector<std::string>& arguments) const;

  const TempDir signs_;
};

/// Whether the text is in it.
[[nodiscard]] ::testing::AssertionResult says(const std::string& text, const std::string& part);

}  // namespace ist::test
