#include "cli/query_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/engine.h"
#include "cli/progress_bar.h"
#include "cli/verify.h"
#include "ist/base/output_file.h"
#include "ist/base/pose.h"
#include "ist/tree/saved_spheres.h"

namespace ist::cli {
namespace {

// What one engine answered at one pose, and how long each time took.
struct Answer {
  QueryResult result;
  std::vector<double> microseconds;

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

nlohmann::ordered_json json_line(std::size_t index, const Engine& engine, const Bodies& bodies,
                                 const Answer& answer) {
  const QueryResult& r = answer.result;
  return {{"index", index},
          {"engine", engine.name()},
          {"spheres", to_string(bodies.policy)},
          {"target", engine.target()},
          {"workers", engine.workers()},
          {"voxel_size", {bodies.fixed.lattice().voxel_size, bodies.moving.lattice().voxel_size}},
          {"resolution", engine.resolution(r)},
          {"complete", r.complete},
          {"truncated", r.truncated},
          {"level", r.level},
          {"colliding", r.contacts > 0},
          {"inside", nullptr},
          {"contacts", r.contacts},
          {"gap_lower", nullptr},
          {"gap_upper", nullptr},
          {"sphere_tests", r.sphere_tests},
          {"microseconds_min", answer.fastest()},
          {"microseconds_median", answer.median()}};
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
                 engines[e]->name(), answer.result.contacts > 0 ? "yes" : "no",
                 answer.result.contacts, answer.result.sphere_tests, answer.median(),
                 answer.fastest(), 1e6 / answer.median());
    }
  }
}

// Centres of the touching spheres, in fixed coordinates.
class ContactWriter {
 public:
  ContactWriter(const std::filesystem::path& file, const Bodies& bodies)
      : file_(file),
        bodies_(bodies),
        fixed_(level_spheres(bodies.fixed, bodies.policy, 0)),
        moving_(level_spheres(bodies.moving, bodies.policy, 0)) {}

  void write(std::size_t index, const Eigen::Isometry3d& pose, std::span<const Contact> contacts) {
    // As the query does: the pose that is answered for is the rigid one nearest to what was given.
    const Eigen::Isometry3d rigid = *project_to_rigid(pose);
    std::string lines;
    for (const Contact& contact : contacts) {
      const Eigen::Vector3d fixed = bodies_.fixed.lattice().origin() + fixed_[contact.fixed].centre;
      const Eigen::Vector3d moving =
          rigid * (bodies_.moving.lattice().origin() + moving_[contact.moving].centre);
      const nlohmann::ordered_json line{{"index", index},
                                        {"fixed_centre", {fixed[0], fixed[1], fixed[2]}},
                                        {"moving_centre", {moving[0], moving[1], moving[2]}}};
      lines += line.dump() + '\n';
      if (lines.size() > (1 << 20)) flush(lines);
    }
    flush(lines);
  }
  void commit() { file_.commit(); }

 private:
  void flush(std::string& lines) {
    file_.write(lines.data(), lines.size());
    lines.clear();
  }
  OutputFile file_;
  const Bodies& bodies_;
  std::vector<Ball> fixed_, moving_;
};

}  // namespace

void run_queries(const Bodies& bodies, std::span<const Eigen::Isometry3d> poses,
                 const QueryOptions& options) {
  const EngineOptions with{bodies.policy, options.target, options.workers};
  Engines engines;
  for (const std::string& name : options.engines) {
    engines.push_back(make_engine(name, bodies.fixed, bodies.moving, with));
  }
  std::unique_ptr<ContactWriter> writer;
  if (!options.contacts.empty()) writer = std::make_unique<ContactWriter>(options.contacts, bodies);

  std::vector<std::vector<Answer>> answers(poses.size(), std::vector<Answer>(engines.size()));
  Progress progress;
  progress.begin_stage("asking", static_cast<std::uint64_t>(options.repeat) * poses.size());
  auto bar = std::make_unique<ProgressBar>(progress);
  for (int round = 0; round < options.repeat; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t e = 0; e < engines.size(); ++e) {
        const auto [result, microseconds] = engines[e]->ask(poses[i]);
        answers[i][e].result = result;
        answers[i][e].microseconds.push_back(microseconds);
        if (writer != nullptr && round == 0 && e == 0) {
          writer->write(i, poses[i], engines[e]->contacts());
        }
      }
      progress.add(1);
    }
  }
  bar.reset();
  if (options.verify) verify(engines, bodies, poses);
  if (writer != nullptr) writer->commit();
  if (!options.json) {
    print_table(engines, bodies, answers);
    return;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      fmt::print("{}\n", json_line(i, *engines[e], bodies, answers[i][e]).dump());
    }
  }
}

}  // namespace ist::cli
