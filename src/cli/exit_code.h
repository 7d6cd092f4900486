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
  kInterrupted = 130,  // as a shell tells the end by a signal
};

struct ExitMeaning {
  int code;
  const char* meaning;
};
inline constexpr ExitMeaning kExitMeanings[] = {
    {0, "fine"},
    {kFailed, "failed"},
    {kUsage, "usage"},
    {kBadInput, "bad input file"},
    {kDeadlinesMissed, "deadlines missed (run)"},
    {kGuaranteeBroken,
     "a result breaks a guarantee (--verify), or differs from the model (table --check)"},
    {kTouching, "the bodies touch, or may, or one lies in the other (--fail-if-touching)"},
    {kInterrupted, "interrupted"},
};

/// A failure with an exit code of its own: a result that breaks the guarantee, more missed
/// deadlines than --allow-missed, bodies that touch, or may, where they must not, or a sweep that a
/// signal ended.
struct Failure : std::runtime_error {
  Failure(ExitCode code, const std::string& what) : std::runtime_error(what), exit_code(code) {}

  ExitCode exit_code;
};

}  // namespace ist::cli
