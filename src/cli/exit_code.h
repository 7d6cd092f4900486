#pragma once

#include <stdexcept>
#include <string>

namespace ist::cli {

/// The exit codes of the command, besides 0.
enum ExitCode : int {
  kFailed = 1,
  kUsage,
  kBadInput,
  kDeadlinesMissed,
  kGuaranteeBroken,
  kTouching,
};

/// A failure with an exit code of its own: a result that breaks the guarantee, more missed
/// deadlines than --allow-missed, or bodies that touch where they must not.
struct Failure : std::runtime_error {
  Failure(ExitCode code, const std::string& what) : std::runtime_error(what), exit_code(code) {}

  ExitCode exit_code;
};

}  // namespace ist::cli
