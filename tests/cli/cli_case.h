#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
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
  /// Shifts along x as a file of poses.
  [[nodiscard]] std::string poses(const std::vector<double>& shifts) const;

  /// Processes that a signal ends leave no core from now on.
  static void leave_no_core();
  /// Waits until the folder has that number of entries, or the process has ended.
  void await_entries(std::size_t entries, Process& process) const;
  /// Runs it with a system call that does not return any more, once it has returned `after` times.
  [[nodiscard]] Process with_held_call(const std::string& call, int after,
                                       const std::vector<std::string>& arguments) const;
  /// Waits until that system call does not return.
  void await_hold(Process& process) const;
  /// Runs it with a system call that fails by EIO, once it has succeeded `after` times.
  [[nodiscard]] CommandResult with_failing_call(const std::string& call, int after,
                                                const std::vector<std::string>& arguments) const;

  /// The lines of a text, each an object of JSON, without the header.
  static std::vector<nlohmann::json> json_lines(const std::string& text);

  const TempDir dir_;

 private:
  [[nodiscard]] Process with_call(const std::string& call, int after, const std::string& fails,
                                  const std::vector<std::string>& arguments) const;
};

/// Whether the text is in it.
[[nodiscard]] ::testing::AssertionResult says(const std::string& text, const std::string& part);

}  // namespace ist::test
