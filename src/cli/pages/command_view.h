#pragma once

#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// The description of an option, or of a positional argument.
struct OptionView {
  std::vector<std::string> spellings;  ///< such as -o and --output; of an argument its name alone
  std::string value;                   ///< such as file; empty for a flag
  std::vector<std::string> choices;    ///< the only values, if the set is fixed
  std::string range;                   ///< such as 1 to 2; empty: any
  std::string default_value;
  std::vector<std::string> excluded;  ///< options that it does not go with, by name
  std::string description;
  bool is_argument = false, required = false;
};

struct OptionGroup {
  std::string title;
  std::vector<OptionView> options;
};

/// The description of the command or of a subcommand.
struct CommandView {
  std::string name;         ///< such as collide; ist for the command itself
  std::string description;  ///< begins with a capital, and has no full stop
  std::vector<OptionView> arguments;
  std::vector<OptionGroup> groups;
  std::vector<std::string> notes;  ///< paragraphs
  std::vector<std::string> examples;
};

/// Returns the view of a command, by the same description from which CLI11 prints --help.
[[nodiscard]] CommandView command_view(const CLI::App& command);

}  // namespace ist::cli
