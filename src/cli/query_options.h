#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "answers/engine.h"
#include "answers/examiner.h"
#include "cli/cli11_fwd.h"
#include "cli/load_bodies.h"

namespace ist::cli {

/// The options of collide and approach, but for the poses.
struct QuestionOptions {
  std::string subcommand;  ///< whose options they are
  BodyFiles files;
  answers::Questions questions;
  std::filesystem::path contacts;  ///< file for leaf pairs and contacts; empty: not written
  bool fail_if_touching = false;
  bool json = false;

  // The engine.
  std::string spheres;               ///< empty: the tightest that both bodies have
  std::vector<std::string> engines;  ///< as named; empty: the first of kEngineNames
  std::string target;                ///< instruction set; empty: IST_TARGET's, or the best
  int workers = 1;
  int repeat = 1;
  bool timing = false;
  bool verify = false;

  /// Throws a Refusal if options contradict each other, and kTargetMissing.
  void check() const;
  /// Returns an option that needs voxels: contacts, times and engines do. nullptr: all questions
  /// are about triangles.
  [[nodiscard]] const char* asks_voxels() const;
  /// Returns the engines that answer, one or two.
  [[nodiscard]] std::vector<std::string> asked_engines() const;
  /// Returns the files with the chosen policy, and without voxels if no question needs them.
  [[nodiscard]] BodyFiles body_files() const;
};

/// Adds the options of a query to a subcommand.
void add_query_options(CLI::App& command, QuestionOptions& options);

}  // namespace ist::cli
