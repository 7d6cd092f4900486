#pragma once

#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// The description of an option.
struct OptionView {
  std::vector<std::string> spellings;  ///< such as -o and --output
  std::string value;                   ///< such as FILE; empty for a flag
  std::vector<std::string> choices;    ///< the only values, if the set is fixed
};

/// The description of the command or of a subcommand.
struct CommandView {
  std::string name;                 ///< such as collide; ist for the command itself
  std::vector<OptionView> options;  ///< in the order of the help
  bool takes_files = false;         ///< as arguments without an option
  std::vector<std::string> notes;   ///< the help's last paragraphs, without the examples
  std::vector<std::string> examples;
};

/// Returns the view of a command, from the same description as its help.
[[nodiscard]] CommandView command_view(const CLI::App& command);

/// Returns the script that completes subcommands, their options, the values of options whose set is
/// fixed, and files, in bash. `version` is as in ist 1.2.3.
[[nodiscard]] std::string bash_completion(const CommandView& command,
                                          const std::vector<CommandView>& subcommands,
                                          const std::string& version);

}  // namespace ist::cli
