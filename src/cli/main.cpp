#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "cli/app.h"
#include "cli/exit_code.h"
#include "cli/interruption.h"
#include "cli/terminal.h"
#include "cli/words.h"
#include "ist/base/error.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

ExitCode exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::kFileUnwritable:
      return kFailed;
    case ErrorCode::kVoxelSizeInvalid:
    case ErrorCode::kVoxelSizeTooSmall:
    case ErrorCode::kMemoryLimit:
    case ErrorCode::kPolicyMissing:
    case ErrorCode::kTrianglesMissing:
    case ErrorCode::kTargetMissing:
    case ErrorCode::kFixedPointRange:
      return kUsage;
    default:
      return kBadInput;
  }
}

int run(int argc, char** argv) {
  install_signal_handlers();
  const std::unique_ptr<CLI::App> app = make_app();
  std::vector<std::string> words = words_of(argc, argv);
  try {
    refuse_wrong_words(*app, words);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app->parse(words);
  } catch (const CLI::Success& asked) {  // help, or the version
    std::ostringstream text;
    const int code = app->exit(asked, text, text);
    if (std::fputs(text.str().c_str(), stdout) < 0) fail_stdout();
    flush_stdout();
    return code;
  } catch (const CLI::ParseError& error) {
    // No option is read as anything else than a text or a number.
    const bool no_number = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
    std::fprintf(stderr, "ist: %s%s\nTry 'ist %s--help'.\n", error.what(),
                 no_number ? ": give a number as its help says" : "",
                 subcommand_among(*app, argc, argv).c_str());
    return kUsage;
  }
  // An earlier write that failed, as on a full disk, shows here at the latest.
  flush_stdout();
  return 0;
}

bool is_broken_pipe(const std::exception& error) {
  const auto* const system = dynamic_cast<const std::system_error*>(&error);
  const auto* const file = dynamic_cast<const UnwritableFile*>(&error);
  return (system != nullptr && system->code() == std::errc::broken_pipe) ||
         (file != nullptr && file->cause() == EPIPE);
}

// The standard library and TBB report it by the text alone.
bool is_lack_of_threads(const std::exception& error) {
  return std::strstr(error.what(), std::strerror(EAGAIN)) != nullptr;
}

}  // namespace
}  // namespace ist::cli

int main(int argc, char** argv) try {
  return ist::cli::run(argc, argv);
} catch (const ist::Error& error) {
  if (ist::cli::is_broken_pipe(error)) ist::cli::end_by_broken_pipe();
  if (error.code() == ist::ErrorCode::kCancelled) {  // by a signal alone
    std::fprintf(stderr, "ist: interrupted\n");
    return ist::cli::kInterrupted;
  }
  std::fprintf(stderr, "ist: %s [%s]\n", error.what(), ist::to_string(error.code()));
  return ist::cli::exit_code(error.code());
} catch (const ist::cli::Failure& failure) {
  std::fprintf(stderr, "ist: %s\n", failure.what());
  return failure.exit_code;
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "ist: out of memory: use a larger voxel size, or --max-memory\n");
  return ist::cli::kFailed;
} catch (const std::exception& error) {
  if (ist::cli::is_broken_pipe(error)) ist::cli::end_by_broken_pipe();
  std::fprintf(
      stderr, "ist: %s%s\n", error.what(),
      ist::cli::is_lack_of_threads(error)
          ? ": no memory for a thread, or too many of them: raise the limit (ulimit -v, -u)"
          : "");
  return ist::cli::kFailed;
}
