#include "cli/query_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/contact_writer.h"
#include "cli/depth_meter.h"
#include "cli/engine.h"
#include "cli/exit_code.h"
#include "cli/progress_bar.h"
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/tree_parts.h"
#include "verify/answer_verifier.h"

namespace ist::cli {
namespace {

// An engine's answer at one pose, and the time of each run.
struct Answer {
  Engine::Answer last;
  std::optional<Inside> inside;  // if requested, and no triangles intersect
  std::optional<Depth> depth;    // if requested
  std::vector<double> microseconds;

  // Returns nothing if the query stopped before it knew.
  [[nodiscard]] std::optional<bool> colliding() const {
    if (last.triangle_pairs) return *last.triangle_pairs > 0;
    if (last.result.leaf_pairs == 0 && !last.result.complete) return std::nullopt;
    return last.result.leaf_pairs > 0;
  }

  [[nodiscard]] double fastest() const {
    return *std::min_element(microseconds.begin(), microseconds.end());
  }
  [[nodiscard]] double median() const {
    std::vector<double> sorted = microseconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
  }
};

template <class Number>
nlohmann::ordered_json or_null(const std::optional<Number>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json json_line(std::size_t index, const Engine& engine, const Bodies& bodies,
                                 const QueryOptions& options, const Answer& answer) {
  const QueryResult& r = answer.last.result;
  const std::optional<DistanceInterval>& gap = answer.last.gap;
  nlohmann::ordered_json line{
      {"index", index},
      {"engine", engine.name()},
      {"spheres", to_string(bodies.policy)},
      {"target", engine.target()},
      {"workers", engine.workers()},
      {"voxel_size", {bodies.fixed.voxel_size(), bodies.moving.voxel_size()}},
      {"resolution", r.resolution},
      {"complete", r.complete},
      {"truncated", r.truncated},
      {"level", r.level},
      {"colliding", or_null(answer.colliding())},
      {"inside", answer.inside ? nlohmann::ordered_json(to_string(*answer.inside)) : nullptr},
      {"contacts", r.leaf_pairs}};
  if (options.exact) line["triangle_pairs"] = or_null(answer.last.triangle_pairs);
  line["gap_lower"] = gap ? nlohmann::ordered_json(gap->lower) : nullptr;
  line["gap_upper"] = gap ? nlohmann::ordered_json(gap->upper) : nullptr;
  if (answer.depth) {
    line["depth_lower"] = answer.depth->lower;
    line["depth_upper"] = answer.depth->upper;
    line["depth_at_vertices"] = answer.depth->at_vertices;
    line["contact_depth"] = or_null(answer.depth->of_contact);
  }
  line["sphere_tests"] = r.sphere_tests;
  line["microseconds_min"] = answer.fastest();
  line["microseconds_median"] = answer.median();
  return line;
}

// Prints the results beyond leaf pairs, in words, below the table's line.
void print_beside(const Answer& answer) {
  const Engine::Answer& last = answer.last;
  std::string words;
  const auto add = [&words](const std::string& more) {
    words += (words.empty() ? "" : ", ") + more;
  };
  if (last.triangle_pairs) add(fmt::format("{} pairs of triangles", *last.triangle_pairs));
  if (answer.inside && *answer.inside != Inside::kNone) {
    add(fmt::format("the {} body is inside", to_string(*answer.inside)));
  }
  if (last.gap) {
    add(fmt::format("gap {:.6g} to {:.6g}", last.gap->lower, last.gap->upper));
  }
  if (answer.depth) {
    const Depth& depth = *answer.depth;
    add(fmt::format("penetration depth {:.6g} to {:.6g}, {:.6g} at vertices", depth.lower,
                    depth.upper, depth.at_vertices));
    if (depth.of_contact) add(fmt::format("contact depth {:.6g}", *depth.of_contact));
  }
  if (!last.result.complete) add(fmt::format("stopped at level {}", last.result.level));
  if (!words.empty()) fmt::print("{:>5}  {}\n", "", words);
}

// By pose, then by engine.
using Answers = std::vector<std::vector<Answer>>;

void print_table(const Engines& engines, const Bodies& bodies, const Answers& answers) {
  fmt::print("spheres {}, voxel size {} and {}", to_string(bodies.policy),
             bodies.fixed.voxel_size(), bodies.moving.voxel_size());
  for (const Engine& engine : engines) {
    fmt::print("; {}: {}, {} worker{}", engine.name(), engine.target(), engine.workers(),
               engine.workers() == 1 ? "" : "s");
  }
  fmt::print("\n");
  fmt::print("{:>5}  {:<10} {:>9} {:>10} {:>12} {:>12} {:>10} {:>10}\n", "index", "engine", "touch",
             "contacts", "tests", "median µs", "min µs", "rate Hz");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Answer& answer = answers[i][e];
      const std::optional<bool> colliding = answer.colliding();
      const char* touch = !colliding ? "?" : (*colliding ? "yes" : "no");
      fmt::print("{:>5}  {:<10} {:>9} {:>10} {:>12} {:>12.1f} {:>10.1f} {:>10.0f}\n", i,
                 engines[e].name(), touch, answer.last.result.leaf_pairs,
                 answer.last.result.sphere_tests, answer.median(), answer.fastest(),
                 1e6 / answer.median());
      print_beside(answer);
    }
  }
}

Answers ask(Engines& engines, std::span<const Eigen::Isometry3d> poses, int repeat,
            const std::optional<InsideTest>& inside, std::optional<DepthMeter>& depth,
            std::optional<ContactWriter>& writer) {
  Answers answers(poses.size(), std::vector<Answer>(engines.size()));
  ProgressBar progress;
  progress.begin_stage("asking", static_cast<std::uint64_t>(repeat) * poses.size());
  for (int round = 0; round < repeat; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t e = 0; e < engines.size(); ++e) {
        Answer& answer = answers[i][e];
        answer.last = engines[e].ask(poses[i]);
        answer.microseconds.push_back(answer.last.microseconds);
        if (inside && round == 0 && answer.last.triangle_pairs == 0U) {
          answer.inside = inside->at(*project_to_rigid(poses[i]));
        }
        if (depth && round == 0) {
          answer.depth = e == 0 ? depth->ask(poses[i]) : *answers[i][0].depth;
        }
        if (writer && round == 0 && e == 0) {
          writer->write(i, poses[i], engines[e].leaf_pairs(), answer.last.result.complete);
        }
      }
      progress.add(1);
    }
  }
  return answers;
}

// Runs each engine at each pose once more, untimed, and checks the answers against the guarantee.
// Prints the checked properties to stderr; throws a Failure that names pose, engine and pair.
void verify(Engines& engines, const Bodies& bodies, std::span<const Eigen::Isometry3d> poses) {
  const AnswerVerifier check(bodies.fixed, bodies.moving, bodies.policy);
  {
    ProgressBar progress;
    progress.begin_stage("verifying", poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      std::vector<GivenAnswer> answers;
      for (Engine& engine : engines) {
        const QueryResult result = engine.ask(poses[i]).result;
        answers.push_back({result, engine.leaf_pairs(), engine.nested()});
      }
      if (const std::optional<Violation> violation = check.check(poses[i], answers)) {
        throw Failure(
            kGuaranteeBroken,
            fmt::format("pose {}, engine {}: {}. This is an error in ist: please report it with "
                        "both bodies and the pose",
                        i, engines[violation->answer].name(), violation->detail));
      }
      progress.add(1);
    }
  }
  const bool by_triangles = !is_implicit(bodies.policy) && check.knows_geometry();
  for (const Engine& engine : engines) {
    std::fprintf(
        stderr,
        "verified, %s: at each of %zu poses, the bounds of every leaf pair overlap, and no "
        "pair of voxels whose %s is missing\n",
        std::string(engine.name()).c_str(), poses.size(),
        !engine.nested() ? "cubes intersect"
        : by_triangles   ? "bounds overlap or whose triangles cross"
                         : "bounds overlap");
  }
}

}  // namespace

void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options) {
  std::optional<InsideTest> inside;
  if (options.exact) {
    require_triangles(bodies);
    inside.emplace(bodies.fixed.parts().triangles->mesh, bodies.moving.parts().triangles->mesh);
  }
  Engines engines;
  for (const std::string& name : options.engines) {
    engines.emplace_back(name, bodies.fixed, bodies.moving,
                         EngineOptions{bodies.policy, options.target, options.workers,
                                       options.exact, options.max_tests, options.gap});
  }
  std::optional<DepthMeter> depth;
  if (options.depth) depth.emplace(bodies, *options.depth);
  std::optional<ContactWriter> writer;
  if (!options.leaf_pairs.empty()) writer.emplace(options.leaf_pairs, bodies);
  const Answers answers = ask(engines, poses, options.repeat, inside, depth, writer);
  if (options.verify) verify(engines, bodies, poses);
  if (writer) writer->commit();
  if (!options.json) return print_table(engines, bodies, answers);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      fmt::print("{}\n", json_line(i, engines[e], bodies, options, answers[i][e]).dump());
    }
  }
}

}  // namespace ist::cli
