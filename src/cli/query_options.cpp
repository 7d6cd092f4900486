#include "cli/query_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "answers/refusals.h"
#include "cli/common_options.h"
#include "cli/contact_file.h"
#include "simd/dispatch.h"

namespace ist::cli {

using namespace answers;

namespace {

void add_engine_options(CLI::App& command, QuestionOptions& options) {
  command.option_defaults()->group("Engine, and its times");
  command
      .add_option("--spheres", options.spheres,
                  "bounds of the nodes; by default the tightest that both bodies have")
      ->transform(one_of(policy_names()));
  command
      .add_option("--engine", options.engines,
                  "times simd, the fast query of leaf pairs, or reference, the published one; "
                  "given twice, both in turn")
      ->transform(one_of({kEngineNames.begin(), kEngineNames.end()}))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->default_str(std::string(kEngineNames.front()));
  command
      .add_option("--workers", options.workers,
                  "threads of simd; a second one helps if queries follow each other at once")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command
      .add_option("--target", options.target,
                  "instruction set of simd, one that ist --version lists; by default IST_TARGET of "
                  "the environment, or the first. All answer alike")
      ->type_name("NAME");
  command.add_option("--repeat", options.repeat, "times that each pose is timed; prints --timing")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--max-tests", options.questions.max_tests,
                  "stop each question after this number of tests; distance and depth are then "
                  "wider intervals, and touch is unknown")
      ->transform(whole_number("the number of tests"));
  command.add_flag("--verify", options.verify,
                   "run each engine at each pose once more and check its leaf pairs against the "
                   "guarantee, some 0.1 s a pose; exit code 5 if it is broken");
  command.add_flag("--timing", options.timing, "print leaf pairs, tests and times too");
  command.option_defaults()->group("Options");
}

}  // namespace

void QuestionOptions::check() const {
  for (const std::string& name : engines) {
    refuse_if(std::count(engines.begin(), engines.end(), name) > 1, "--engine", "{} is named twice",
              name);
  }
  refuse_if(questions.max_tests && verify, "--max-tests",
            "contradicts --verify, which checks complete answers");
  if (!contacts.empty()) check_contact_file(contacts);
  refuse_if(json && timing, "--timing", "contradicts --json, which has all times");
  static_cast<void>(select_kernels(target));  // before anything is built
  const std::vector<std::string> asked = asked_engines();
  if (std::find(asked.begin(), asked.end(), "simd") != asked.end()) return;
  constexpr const char* kNoSimd = "goes with --engine simd: the reference is scalar, in one thread";
  refuse_if(!target.empty(), "--target", kNoSimd);
  refuse_if(workers != 1, "--workers", kNoSimd);
  refuse_if(questions.max_tests.has_value(), "--max-tests",
            "goes with --engine simd: the reference finds all leaf pairs");
}

const char* QuestionOptions::asks_voxels() const {
  const std::pair<bool, const char*> options[] = {{timing, "--timing"},
                                                  {repeat > 1, "--repeat"},
                                                  {verify, "--verify"},
                                                  {workers > 1, "--workers"},
                                                  {!spheres.empty(), "--spheres"},
                                                  {!target.empty(), "--target"},
                                                  {!engines.empty(), "--engine"},
                                                  {!contacts.empty(), "--contacts"},
                                                  {files.voxel_size.has_value(), "--voxel-size"}};
  for (const auto& [asks, name] : options) {
    if (asks) return name;
  }
  return nullptr;
}

std::vector<std::string> QuestionOptions::asked_engines() const {
  return engines.empty() ? std::vector<std::string>{std::string(kEngineNames.front())} : engines;
}

BodyFiles QuestionOptions::body_files() const {
  BodyFiles named = files;
  if (!spheres.empty()) named.policy = sphere_policy(spheres);
  if (const char* option = asks_voxels()) {
    named.voxels_for = option;
  } else {
    named.voxels = BodyFiles::Voxels::kNeeded;
  }
  return named;
}

void add_query_options(CLI::App& command, QuestionOptions& options) {
  options.subcommand = command.get_name();
  add_file(command, "FIXED", options.files.fixed, "mesh or tree of the body that stays")
      ->required();
  add_file(command, "MOVING", options.files.moving, "mesh or tree of the body that is moved")
      ->required();
  command.add_option(
      "--voxel-size", options.files.voxel_size,
      "edge of a voxel, in mesh units, for leaf pairs, contacts and times; by default "
      "a 500th of the smaller body's largest extent. Triangles answer all else, so "
      "a mesh gets voxels only if --contacts, an option of the engine or a tree "
      "without triangles needs them");
  command
      .add_option(
          "--distance", options.questions.distance,
          "how sharp the distance of the surfaces shall be; by default a 10,000th of that extent")
      ->check(tolerance());
  command
      .add_option("--depth", options.questions.depth,
                  "how sharp the penetration depth shall be, by default a 10,000th of that extent; "
                  "it is how deep the deepest point of either surface lies in the other body")
      ->check(tolerance());
  command.add_flag("--exact", options.questions.triangle_pairs,
                   "count all pairs of triangles that meet");
  add_file(command, "--contacts", options.contacts,
           "write leaf pairs, and the contact points that they are reduced to, at most 32 a pose, "
           "in fixed coordinates, to this file, by its ending: " +
               contact_endings());
  command.add_flag("--fail-if-touching", options.fail_if_touching,
                   "exit code 6 where the bodies touch, or may, or one lies in the other, at any "
                   "pose; 1 where that is unknown");
  add_units_and_frame(command, options.files);
  add_max_memory(command, options.files.max_memory);
  command.add_flag("--json", options.json, "print one JSON object a line");
  add_engine_options(command, options);
}

}  // namespace ist::cli
