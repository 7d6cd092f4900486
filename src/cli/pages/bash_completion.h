#pragma once

#include <string>
#include <vector>

#include "cli/pages/command_view.h"

namespace ist::cli {

/// Returns the script that completes subcommands, their options, the values of options whose set is
/// fixed, and files, in bash. `version` is as in ist 1.2.3.
[[nodiscard]] std::string bash_completion(const CommandView& command,
                                          const std::vector<CommandView>& subcommands,
                                          const std::string& version);

}  // namespace ist::cli
