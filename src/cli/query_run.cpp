#include "cli/query_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/contact_writer.h"
#include "cli/engine.h"
#include "cli/progress_bar.h"
#include "cli/verify.h"
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/query/inside.h"

namespace ist::cli {
namespace {

// What one engine answered at one pose, and how long each time took.
struct Answer {
  Engine::Answer last;
  std::optional<Inside> inside;  // where nothing touches, and it was asked
  std::vector<double> microseconds;

  // Nothing where it stopped before it knew.
  [[nodiscard]] std::optional<bool> colliding() const {
    if (last.triangle_pairs) return *last.triangle_pairs > 0;
    if (last.result.contacts == 0 && !last.result.complete) return std::nullopt;
    return last.result.contacts > 0;
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
  std::optional<double> gap_lower, gap_upper;
  if (answer.last.gap) {
    gap_lower = answer.last.gap->lower;
    gap_upper = answer.last.gap->upper;
  }
  std::optional<std::string> inside;
  if (answer.inside) inside = to_string(*answer.inside);
  nlohmann::ordered_json line{
      {"index", index},
      {"engine", engine.name()},
      {"spheres", to_string(bodies.policy)},
      {"target", engine.target()},
      {"workers", engine.workers()},
      {"voxel_size", {bodies.fixed.lattice().voxel_size, bodies.moving.lattice().voxel_size}},
      {"resolution", engine.resolution(r)},
      {"complete", r.complete},
      {"truncated", r.truncated},
      {"level", r.level},
      {"colliding", or_null(answer.colliding())},
      {"inside", or_null(inside)},
      {"contacts", r.contacts}};
  if (options.exact) line["triangle_pairs"] = or_null(answer.last.triangle_pairs);
  line["gap_lower"] = or_null(gap_lower);
  line["gap_upper"] = or_null(gap_upper);
  line["sphere_tests"] = r.sphere_tests;
  line["microseconds_min"] = answer.fastest();
  line["microseconds_median"] = answer.median();
  return line;
}

const char* touch(const std::optional<bool>& colliding) {
  return !colliding ? "?" : *colliding ? "yes" : "no";
}

// What is more than leaves, for those that asked: a line of words under the table's.
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
  if (!last.result.complete) add(fmt::format("stopped at level {}", last.result.level));
  if (!words.empty()) fmt::print("{:>5}  {}\n", "", words);
}

void require_triangles(const Bodies& bodies) {
  for (const auto& [tree, name] : {std::pair(&bodies.fixed, "FIXED"), {&bodies.moving, "MOVING"}}) {
    if (tree->triangles()) continue;
    throw Error(
        ErrorCode::kTrianglesMissing,
        fmt::format("{}: the tree has no triangles: build it with --exact, or name the mesh",
                    name));
  }
}

void print_table(const Engines& engines, const Bodies& bodies,
                 const std::vector<std::vector<Answer>>& answers) {
  fmt::print("spheres {}, voxel size {} and {}", to_string(bodies.policy),
             bodies.fixed.lattice().voxel_size, bodies.moving.lattice().voxel_size);
  for (const auto& engine : engines) {
    fmt::print("; {}: {}, {} worker{}", engine->name(), engine->target(), engine->workers(),
               engine->workers() == 1 ? "" : "s");
  }
  fmt::print("\n");
  fmt::print("{:>5}  {:<10} {:>9} {:>10} {:>12} {:>12} {:>10} {:>10}\n", "index", "engine", "touch",
             "contacts", "tests", "median µs", "min µs", "rate Hz");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Answer& answer = answers[i][e];
      fmt::print("{:>5}  {:<10} {:>9} {:>10} {:>12} {:>12.1f} {:>10.1f} {:>10.0f}\n", i,
                 engines[e]->name(), touch(answer.colliding()), answer.last.result.contacts,
                 answer.last.result.sphere_tests, answer.median(), answer.fastest(),
                 1e6 / answer.median());
      print_beside(answer);
    }
  }
}

}  // namespace

void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options) {
  const EngineOptions with{bodies.policy, options.target,    options.workers,
                           options.exact, options.max_tests, options.gap};
  std::optional<InsideTest> inside;
  if (options.exact) {
    require_triangles(bodies);
    inside.emplace(bodies.fixed.triangles()->mesh, bodies.moving.triangles()->mesh);
  }
  Engines engines;
  for (const std::string& name : options.engines) {
    engines.push_back(make_engine(name, bodies.fixed, bodies.moving, with));
  }
  std::optional<ContactWriter> writer;
  if (!options.contacts.empty()) writer.emplace(options.contacts, bodies);

  std::vector<std::vector<Answer>> answers(poses.size(), std::vector<Answer>(engines.size()));
  Progress progress;
  progress.begin_stage("asking", static_cast<std::uint64_t>(options.repeat) * poses.size());
  auto bar = std::make_unique<ProgressBar>(progress);
  for (int round = 0; round < options.repeat; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t e = 0; e < engines.size(); ++e) {
        Answer& answer = answers[i][e];
        answer.last = engines[e]->ask(poses[i]);
        answer.microseconds.push_back(answer.last.microseconds);
        if (inside && round == 0 && answer.last.triangle_pairs == 0U) {
          answer.inside = inside->at(*project_to_rigid(poses[i]));
        }
        if (writer && round == 0 && e == 0) {
          writer->write(i, poses[i], engines[e]->contacts(), answer.last.result.complete);
        }
      }
      progress.add(1);
    }
  }
  bar.reset();
  if (options.verify) verify(engines, bodies, poses);
  if (writer) writer->commit();
  if (!options.json) {
    print_table(engines, bodies, answers);
    return;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      fmt::print("{}\n", json_line(i, *engines[e], bodies, options, answers[i][e]).dump());
    }
  }
}

}  // namespace ist::cli
