#pragma once

#include <memory>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// The last line of each help.
inline constexpr const char* kPurpose = "Research software, not a medical device.";

/// Returns the command line: all subcommands with their options, whose actions run as it is parsed.
[[nodiscard]] std::unique_ptr<CLI::App> make_app();

}  // namespace ist::cli
