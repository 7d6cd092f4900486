#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// Throws CLI::ValidationError, "OPTION: WHY", if `wrong`.
void refuse_if(bool wrong, const std::string& option, const std::string& why);

/// Throws CLI::ValidationError if `output` is one of the `inputs`.
void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs);

/// Accepts only the decimal digits of a number below 2^64, which `what` names. CLI11 would read -1
/// and too large numbers as the largest one, and 010 as 8.
[[nodiscard]] CLI::Validator whole_number(const std::string& what);

/// Accepts a finite number of mesh units from 0 on.
[[nodiscard]] CLI::Validator tolerance();

}  // namespace ist::cli
