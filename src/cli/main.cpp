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

#include "answers/refusals.h"
#include "cli/app.h"
#include "cli/common_options.h"
#include "cli/exit_code.h"
#include "cli/interruption.h"
#include "cli/terminal.h"
#include "ist/base/error.h"
#include "ist/base/files.h"

namespace ist::cli {

using namespace answers;

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
    case ErrorCode::kVoxelsMissing:
    case ErrorCode::kTargetMissing:
    case ErrorCode::kFixedPointRange:
      return kUsage;
    default:
      return kBadInput;
  }
}

// The words of the version before.
std::string renamed(const std::string& word, const std::string& why) {
  if (word == "close") return "no such subcommand; it is called approach";
  if (word == "--gap") return "no such option; it is called --distance";
  return why;
}

std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* each : app.get_subcommands({})) names.push_back(each->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Returns the words of a command line after the program's name. A first word `help` means --help,
// so that `help run` reads `run --help`. A first word `version` means --version.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return words;
  if (words.front() == "version") words.front() = "--version";
  if (words.front() != "help") return words;
  words.erase(words.begin());
  if (!words.empty() && (words.front() == "help" || words.front() == "version")) words.clear();
  words.resize(std::min<std::size_t>(words.size(), 1));
  words.emplace_back("--help");
  return words;
}

// Throws a Refusal for a subcommand or an option that `app` does not have, and names the one that
// is spelled most like it: CLI11 would first ask for what is required. Throws it for a value of a
// flag too, as in --json=banana, because CLI11 would ask for a number.
void refuse_wrong_words(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return;
  const std::vector<std::string> subcommands = subcommands_of(app);
  const std::string& first = words.front();
  const bool is_option = first.starts_with('-');
  if (!is_option && std::find(subcommands.begin(), subcommands.end(), first) == subcommands.end()) {
    throw Refusal(first, renamed(first, with_nearest("no such subcommand", first, subcommands)));
  }
  const CLI::App& command = is_option ? app : *app.get_subcommand(first);
  const std::vector<std::string> options = options_of(command);
  for (const std::string& word : words) {
    if (word == "--") return;
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(options.begin(), options.end(), name) != options.end()) {
      if (name == word || command.get_option(name)->get_items_expected_max() > 0) continue;
      throw Refusal(name, "takes no value; give it alone");
    }
    throw Refusal(name, renamed(name, with_nearest("no such option", name, options)));
  }
}

// Returns the first word and a space if it is a subcommand, else nothing.
std::string subcommand_among(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> known = subcommands_of(app);
  if (argc < 2 || std::find(known.begin(), known.end(), argv[1]) == known.end()) return {};
  return std::string(argv[1]) + " ";
}

// Prints a usage error to stderr, and returns its exit code.
int tell_usage(const CLI::App& app, const std::string& wrong, int argc, char** argv) {
  std::fprintf(stderr, "ist: %s\nTry 'ist %s--help'.\n", wrong.c_str(),
               subcommand_among(app, argc, argv).c_str());
  return kUsage;
}

int run(int argc, char** argv) {
  if (argc > 0) set_command_word(argv[0]);
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
    return tell_usage(
        *app, std::string(error.what()) + (no_number ? ": give a number as its help says" : ""),
        argc, argv);
  } catch (const Refusal& refusal) {
    return tell_usage(*app, refusal.what(), argc, argv);
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
