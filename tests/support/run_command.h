#pragma once

#include <string>
#include <vector>

namespace ist::test {

/// What a process left behind.
struct CommandResult {
  int exit_code = -1;  ///< 128 + the signal, where one ended it
  std::string out;     ///< all of its stdout
  std::string err;     ///< and of its stderr
};

/// Runs a program, found by its path, and waits for its end. Nothing is read from stdin, and no
/// shell is between: the arguments arrive as they are.
[[nodiscard]] CommandResult run_command(const std::string& program,
                                        const std::vector<std::string>& arguments);

}  // namespace ist::test
