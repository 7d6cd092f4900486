#include "cli/query_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>

#include "simd/dispatch.h"

namespace ist::cli {
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

void refuse_if(bool wrong, const std::string& option, const std::string& why) {
  if (wrong) throw CLI::ValidationError(option, why);
}

void add_example(CLI::App& command, const std::string& example) {
  command.footer(example + "\n" + command.get_parent()->get_footer());
}

void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code neither;
    refuse_if(!output.empty() && std::filesystem::equivalent(output, input, neither),
              output.string(), "writing it would destroy an input: name another file");
  }
}

void add_max_memory(CLI::App& command, std::uint64_t& bytes) {
  // A minus sign would wrap round in an unsigned number.
  const auto refuse_minus = [](const std::string& text) {
    return std::string(text.find('-') == text.npos ? "" : "give a positive number of bytes");
  };
  command
      .add_option("--max-memory", bytes,
                  "most memory for voxels and tree, in bytes, or with K, M or G")
      ->transform(CLI::AsSizeValue(false))
      ->transform(CLI::Validator(refuse_minus, ""))  // applied before the transformation above
      ->default_str("4G");
}

void QueryOptions::check() const {
  for (const std::string& name : engines) {
    refuse_if(std::count(engines.begin(), engines.end(), name) > 1, "--engine",
              fmt::format("{} is named twice", name));
  }
  refuse_if(gap && !std::isfinite(*gap), "--gap", "give a finite tolerance in mesh units");
  refuse_if(depth && !std::isfinite(*depth), "--depth", "give a finite tolerance in mesh units");
  refuse_if(max_tests && exact, "--max-tests", "contradicts --exact, which makes all tests");
  refuse_if(max_tests && gap, "--max-tests",
            "contradicts --gap, which makes the tests that its tolerance needs");
  refuse_if(max_tests && verify, "--max-tests",
            "contradicts --verify, which checks complete answers");
  if (std::find(engines.begin(), engines.end(), "simd") != engines.end()) {
    static_cast<void>(select_kernels(target));  // before anything is built
    return;
  }
  constexpr const char* kNoSimd = "goes with --engine simd: the reference is scalar, in one thread";
  refuse_if(!target.empty(), "--target", kNoSimd);
  refuse_if(workers != 1, "--workers", kNoSimd);
  constexpr const char* kNoAnswer = "goes with --engine simd: the reference finds leaf pairs only";
  refuse_if(exact, "--exact", kNoAnswer);
  refuse_if(gap.has_value(), "--gap", kNoAnswer);
  refuse_if(max_tests.has_value(), "--max-tests", kNoAnswer);
}

BodyFiles QueryOptions::body_files() const {
  BodyFiles named = files;
  if (!spheres.empty()) named.policy = sphere_policy(spheres);
  named.keep_triangles = verify || exact || gap || depth;
  return named;
}

void add_query_options(CLI::App& command, QueryOptions& options) {
  command.add_option("FIXED", options.files.fixed, "mesh or tree of the body that stays")
      ->required();
  command.add_option("MOVING", options.files.moving, "mesh or tree of the body that is moved")
      ->required();
  command.add_option("--voxel-size", options.files.voxel_size,
                     "edge of a voxel, in mesh units; needed if a body is a mesh");
  command
      .add_option("--spheres", options.spheres,
                  "bounds of the nodes; by default the tightest that both bodies have")
      ->check(CLI::IsMember(policy_names()));
  command
      .add_option(
          "--engine", options.engines,
          "simd is the fast query, reference the published one; given twice, both run in turn")
      ->check(CLI::IsMember(std::vector<std::string>(kEngineNames.begin(), kEngineNames.end())))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->capture_default_str();
  command
      .add_option("--workers", options.workers,
                  "threads of simd; a second one helps if queries follow each other at once, so "
                  "name no other engine beside it")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  command.add_option(
      "--target", options.target,
      fmt::format("instruction set of simd: {} on this processor; by default IST_TARGET of the "
                  "environment, or the first. All give the same answers",
                  target_names()));
  command.add_flag("--exact", options.exact,
                   "find the pairs of triangles that intersect, touching included, and which body "
                   "lies inside the other; needs meshes, or trees built with --exact");
  command
      .add_option("--gap", options.gap,
                  "find the distance between the surfaces, to within this tolerance in mesh units; "
                  "without triangles, as sharply as the voxels allow")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::max()));
  command
      .add_option(
          "--depth", options.depth,
          "find the penetration depth, to within this tolerance in mesh units: how deep the "
          "deepest point of either surface lies in the other body; also of the vertices "
          "alone, and of the deepest contact point. Needs closed meshes, or trees of "
          "these built with --exact")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::max()));
  command
      .add_option("--max-tests", options.max_tests,
                  "stop after this number of sphere tests; print the level reached, and an "
                  "interval of the distance (gap_lower, gap_upper)")
      ->transform(whole_number("the number of tests"));
  command.add_option("--repeat", options.repeat, "times that each pose is timed")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--contacts", options.leaf_pairs,
                     "write the first engine's contacts to this file, one JSON object each, in "
                     "fixed coordinates: for each pose all leaf pairs, then the contact points to "
                     "which they are reduced, at most 32");
  command.add_flag("--verify", options.verify,
                   "run each engine at each pose once more and check the answers against the "
                   "guarantee, some 0.1 s a pose; exit code 5 if it is broken. With tight and "
                   "slab, only meshes and trees built with --exact show that bounds hold the "
                   "surface");
  add_max_memory(command, options.files.max_memory);
  command.add_flag("--json", options.json, "print one JSON object a line");
}

}  // namespace ist::cli
