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

/// The names that --spheres takes.
[[nodiscard]] std::vector<std::string> policy_names();

/// Refuses what is not decimal digits of a number below 2^64, which would be taken for another one:
/// -1 for the largest, what is too large for the largest too, and 010 for 8.
[[nodiscard]] CLI::Validator whole_number(const std::string& what);

/// Adds to a subcommand's help an example, and what every help ends with.
void add_example(CLI::App& command, const std::string& example);

/// Throws CLI::ValidationError where writing `output` would destroy one of the `inputs`.
void keep_inputs(const std::filesystem::path& output,
                 std::initializer_list<std::filesystem::path> inputs);

void add_max_memory(CLI::App& command, std::uint64_t& bytes);

/// What collide and close share.
struct QueryOptions {
  BodyFiles files;
  std::string spheres;  ///< empty: the best that both bodies have
  std::vector<std::string> engines{kEngineNames.front()};
  std::string target;  ///< empty: IST_TARGET's, or the best
  int workers = 1;
  int repeat = 1;
  std::filesystem::path contacts;  ///< empty: not written
  bool exact = false;
  std::optional<std::uint64_t> max_tests;
  std::optional<double> gap;
  bool verify = false;
  bool json = false;

  /// Throws CLI::ValidationError where options contradict each other, and kTargetMissing.
  void check() const;
  /// The files, with the policy that is named; triangles are kept for --verify,
  /// --exact and --gap.
  [[nodiscard]] BodyFiles body_files() const;
};

void add_query_options(CLI::App& command, QueryOptions& options);

}  // namespace ist::cli
