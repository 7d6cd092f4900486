#pragma once

#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// Returns the words of a command line after the program's name. `help` as the first of them means
/// --help: `help run` reads `run --help`. `version` means --version.
[[nodiscard]] std::vector<std::string> words_of(int argc, char** argv);

/// Throws CLI::ValidationError for a subcommand or an option that `app` does not have, and names
/// the one that is spelled most like it. Otherwise CLI11 would first ask for what is required.
/// Throws it for a value of a flag too, as in --json=banana, for which CLI11 wants a number.
void refuse_wrong_words(const CLI::App& app, const std::vector<std::string>& words);

/// Returns the first word and a space, where it is a subcommand; else nothing.
[[nodiscard]] std::string subcommand_among(const CLI::App& app, int argc, char** argv);

}  // namespace ist::cli
