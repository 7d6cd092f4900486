#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "support/temp_dir.h"

namespace ist::test {

/// The outcome of a process.
struct CommandResult {
  int exit_code = -1;  ///< 128 + the signal, where one ended it
  std::string out;     ///< all of its stdout
  std::string err;     ///< and of its stderr
};

/// A program that runs beside its caller. Nothing is read from stdin, and no shell is between: the
/// arguments arrive as they are. Signals do to it what they do by default, whatever the caller
/// ignores.
class Process {
 public:
  /// @param program found by its path
  /// @param terminal its stderr, where that is to be a terminal; then it is no part of the result
  Process(const std::string& program, const std::vector<std::string>& arguments,
          const std::string& terminal = "");
  /// Kills it where it was not waited for.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int signal) const;
  [[nodiscard]] bool is_running();
  [[nodiscard]] CommandResult wait();

 private:
  const TempDir dir_;
  pid_t id_ = 0;
  std::optional<int> status_;  // once it has ended
};

/// Runs a program and waits for its end.
[[nodiscard]] CommandResult run_command(const std::string& program,
                                        const std::vector<std::string>& arguments);

}  // namespace ist::test
