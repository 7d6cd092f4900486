#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "cli/bodies.h"
#include "cli/engine.h"

namespace ist::cli {

/// Returns the values of --spheres.
[[nodiscard]] std::vector<std::string> policy_names();

/// Accepts only the decimal digits of a number below 2^64, which `what` names. CLI11 would read -1
/// and too large numbers as the largest one, and 010 as 8.
[[nodiscard]] CLI::Validator whole_number(const std::string& what);

/// Throws CLI::ValidationError, "OPTION: WHY", if `wrong`.
void refuse_if(bool wrong, const std::string& option, const std::string& why);

/// Adds an example to the end of a subcommand's help, before the common footer.
void add_example(CLI::App& command, const std::string& example);

/// Throws CLI::ValidationError if `output` is one of the `inputs`.
void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs);

/// Adds --max-memory, bytes.
void add_max_memory(CLI::App& command, std::uint64_t& bytes);

/// The options of collide and close.
struct QueryOptions {
  BodyFiles files;
  std::string spheres;  ///< empty: the tightest that both bodies have
  std::vector<std::string> engines{kEngineNames.front()};
  std::string target;  ///< instruction set; empty: IST_TARGET's, or the best
  int workers = 1;
  int repeat = 1;
  std::filesystem::path leaf_pairs;  ///< file for leaf pairs and contacts; empty: not written
  bool exact = false;
  std::optional<std::uint64_t> max_tests;
  std::optional<double> gap, depth;  ///< tolerances, mesh units
  bool verify = false;
  bool json = false;

  /// Throws CLI::ValidationError if options contradict each other, and kTargetMissing.
  void check() const;
  /// Returns the files with the chosen policy; keeps triangles for what needs or tells them.
  [[nodiscard]] BodyFiles body_files() const;
};

/// Adds the options of a query to a subcommand.
void add_query_options(CLI::App& command, QueryOptions& options);

}  // namespace ist::cli
