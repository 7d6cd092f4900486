#include "cli/query_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>

#include "ist/query/kernels.h"

namespace ist::cli {
namespace {

// A minus would wrap round in a number without sign.
CLI::Validator no_minus() {
  return {[](const std::string& text) {
            return text.find('-') == std::string::npos ? std::string()
                                                       : "give a positive number of bytes";
          },
          ""};
}

}  // namespace

std::vector<std::string> policy_names() {
  std::vector<std::string> names;
  for (const SpherePolicy policy : kSpherePolicies) {
    names.emplace_back(to_string(policy));
  }
  return names;
}

CLI::Validator whole_number(const std::string& what) {
  return {[what](const std::string& text) {
            std::uint64_t value = 0;
            const char* end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            const bool reads_so = error == std::errc() && stop == end;
            const bool octal = text.size() > 1 && text.front() == '0';
            return reads_so && !octal
                       ? std::string()
                       : fmt::format("{}: give {} as decimal digits, less than 2^64", text, what);
          },
          ""};
}

void add_example(CLI::App& command, const std::string& example) {
  command.footer(example + "\n" + command.get_parent()->get_footer());
}

void keep_inputs(const std::filesystem::path& output,
                 std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code neither;
    if (!output.empty() && std::filesystem::equivalent(output, input, neither)) {
      throw CLI::ValidationError(output.string(),
                                 "writing it would destroy an input: name another file");
    }
  }
}

void add_max_memory(CLI::App& command, std::uint64_t& bytes) {
  command
      .add_option("--max-memory", bytes,
                  "most memory that voxels and tree may take, in bytes; K, M and G are understood")
      ->transform(CLI::AsSizeValue(false))
      ->transform(no_minus())  // of the two transformations, the first to be done
      ->default_str("4G");
}

void QueryOptions::check() const {
  for (auto name = engines.begin(); name != engines.end(); ++name) {
    if (std::find(std::next(name), engines.end(), *name) != engines.end()) {
      throw CLI::ValidationError("--engine", fmt::format("{} is named twice", *name));
    }
  }
  if (gap && !std::isfinite(*gap)) {
    throw CLI::ValidationError("--gap", "give a tolerance in mesh units");
  }
  if (max_tests && exact) {
    throw CLI::ValidationError("--max-tests", "contradicts --exact, which tests all");
  }
  if (max_tests && gap) {
    throw CLI::ValidationError("--max-tests", "contradicts --gap, which tests what it must");
  }
  if (max_tests && verify) {
    throw CLI::ValidationError("--max-tests",
                               "contradicts --verify, which asks for complete answers");
  }
  if (std::find(engines.begin(), engines.end(), "simd") != engines.end()) {
    static_cast<void>(find_kernels(target));  // before anything is built
    return;
  }
  constexpr const char* kNoSimd = "goes with --engine simd: the reference is scalar, in one thread";
  if (!target.empty()) throw CLI::ValidationError("--target", kNoSimd);
  if (workers != 1) throw CLI::ValidationError("--workers", kNoSimd);
  constexpr const char* kNoAnswer = "goes with --engine simd: the reference finds leaves alone";
  if (exact) throw CLI::ValidationError("--exact", kNoAnswer);
  if (gap) throw CLI::ValidationError("--gap", kNoAnswer);
  if (max_tests) throw CLI::ValidationError("--max-tests", kNoAnswer);
}

BodyFiles QueryOptions::body_files() const {
  BodyFiles named = files;
  if (!spheres.empty()) named.policy = sphere_policy(spheres);
  named.keep_triangles = verify || exact || gap.has_value();
  return named;
}

void add_query_options(CLI::App& command, QueryOptions& options) {
  command.add_option("FIXED", options.files.fixed, "mesh or tree of the body that stays")
      ->required();
  command.add_option("MOVING", options.files.moving, "mesh or tree of the body that is moved")
      ->required();
  command.add_option("--voxel-size", options.files.voxel_size,
                     "edge of a voxel, in mesh units; for meshes, which are voxelised first");
  command
      .add_option("--spheres", options.spheres,
                  "how nodes are read as spheres; by default the tightest that both bodies have")
      ->check(CLI::IsMember(policy_names()));
  command
      .add_option(
          "--engine", options.engines,
          "simd is the fast path, reference the published query; may be given for each, and "
          "they are asked in turn")
      ->check(CLI::IsMember(std::vector<std::string>(kEngineNames.begin(), kEngineNames.end())))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->capture_default_str();
  command
      .add_option("--workers", options.workers,
                  "threads of simd; a second one helps where queries follow at once, so name no "
                  "other engine beside it")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command.add_option("--target", options.target,
                     fmt::format("instruction set of simd: {} on this processor; by default what "
                                 "the environment's IST_TARGET names, or the first. All answer "
                                 "alike",
                                 target_names()));
  command.add_flag("--exact", options.exact,
                   "find the pairs of triangles that meet, touching included, and which body lies "
                   "inside the other; of meshes, or of trees built with --exact");
  command
      .add_option("--gap", options.gap,
                  "find the distance between the surfaces, to within this tolerance in mesh units; "
                  "of trees without triangles, as far as their voxels tell")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::max()));
  command
      .add_option("--max-tests", options.max_tests,
                  "stop after so many tests, and print what is known by then: the level, and an "
                  "interval that the gap is in")
      ->transform(whole_number("how many tests"));
  command.add_option("--repeat", options.repeat, "how often to time each pose")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--contacts", options.contacts,
                     "write the first engine's contacts here, one JSON object each, in fixed "
                     "coordinates: of each pose all leaf pairs, and then the contact points they "
                     "come to, at most 32");
  command.add_flag(
      "--verify", options.verify,
      "ask each engine each pose once more and check those answers against what is promised, some "
      "0.1 s a pose; exit code 5 if a promise is broken. With tight and slab, only meshes and "
      "trees built with --exact show whether a pair is missing");
  add_max_memory(command, options.files.max_memory);
  command.add_flag("--json", options.json, "print one JSON object a line");
}

}  // namespace ist::cli
