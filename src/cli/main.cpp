#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands/commands.h"
#include "cli/exit_code.h"
#include "cli/interruption.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "cli/words.h"
#include "ist/base/error.h"

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
  CLI::App app(
      "Finds where two rigid triangle meshes touch, how deep and how far apart they are.\n"
      "Try 'ist demo' first: it needs no files.\n"
      "Lengths are in the unit of the mesh files, millimetres by habit.",
      "ist");
  app.require_subcommand(1);
  app.set_version_flag("-V,--version", version_lines());
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Exit codes: 0 fine, 1 failed, 2 usage, 3 bad input file, 4 deadlines missed (run),\n"
      "5 a result breaks a guarantee (--verify), or differs from the model (table --check),\n"
      "6 touching (--fail-if-touching), 130 interrupted.\n"
      "Research software, not a medical device.");
  add_demo(app);
  add_build(app);
  add_info(app);
  add_export(app);
  add_collide(app);
  add_approach(app);
  add_occlusion(app);
  add_run(app);
  add_advise(app);
  add_table(app);
  std::vector<std::string> words = words_of(argc, argv);
  try {
    refuse_unknown_words(app, words);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app.parse(words);
  } catch (const CLI::Success& help) {  // or the version, which its own command prints
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "ist: %s\nTry 'ist %s--help'.\n", error.what(),
                 subcommand_among(app, argc, argv).c_str());
    return kUsage;
  }
  // An earlier write that failed, as on a full disk, shows here at the latest.
  flush_stdout();
  return 0;
}

bool is_broken_pipe(const std::exception& error) {
  const auto* const system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && system->code() == std::errc::broken_pipe;
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
