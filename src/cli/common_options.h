#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "cli/cli11_fwd.h"

namespace ist::cli {

/// Returns the values of --spheres.
[[nodiscard]] std::vector<std::string> policy_names();

/// Returns `why`, and after it the known word that is spelled most like `word`, if one is near.
[[nodiscard]] std::string with_nearest(const std::string& why, const std::string& word,
                                       const std::vector<std::string>& known);

/// Accepts one of `words` in any case, and takes their spelling. For Option::transform().
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

/// Accepts the name of a unit in any case. For Option::transform().
[[nodiscard]] CLI::Validator unit_name();

/// Adds an option or an argument that names a file.
CLI::Option* add_file(CLI::App& command, const std::string& name, std::filesystem::path& file,
                      const std::string& help);

/// Adds an example to the end of a subcommand's help, before the common footer.
void add_example(CLI::App& command, const std::string& example);

/// Adds --max-memory, bytes. `of` names the memory in the help.
void add_max_memory(CLI::App& command, std::uint64_t& bytes,
                    const std::string& of = "voxels and tree");

/// Throws a Refusal if `output` is one of the `inputs`.
void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs);

/// Checks an output before long work: throws what refuse_to_overwrite() and require_writable()
/// throw. An empty name is no output.
void check_output(const std::filesystem::path& output,
                  std::initializer_list<std::filesystem::path> inputs);

/// Accepts only the decimal digits of a number below 2^64, which `what` names. CLI11 would read -1
/// and too large numbers as the largest one, and 010 as 8.
[[nodiscard]] CLI::Validator whole_number(const std::string& what);

/// Accepts a finite number of mesh units from 0 on.
[[nodiscard]] CLI::Validator tolerance();

}  // namespace ist::cli
