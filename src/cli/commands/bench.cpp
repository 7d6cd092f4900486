#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>

#include "advise/closing_path.h"
#include "answers/engine.h"
#include "answers/measure_progress.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/poses/pose_file.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"
#include "ist/models/models.h"

namespace ist::cli {

using namespace answers;

namespace {

using Listed = std::optional<std::uint64_t>;  // pairs, if the answer is a list

struct BenchArguments {
  BodyFiles files;
  std::filesystem::path poses;
  double seconds = 6;
  bool json = false;
};

// A way to ask a question, the place of the way that it is compared with, and its times.
struct BenchWay {
  std::string question, way, spheres;
  int workers;
  std::optional<std::size_t> over;
  std::function<Listed(const Eigen::Isometry3d&)> ask;
  Listed listed = {};              // at all poses together
  std::vector<double> times = {};  // microseconds, sorted before they are printed
  [[nodiscard]] double quantile(double part) const {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  }
};

Bodies built_in_jaws(const BodyFiles& files) {
  check_voxel_size(files.voxel_size);
  const BuildOptions build{.voxel_size = files.voxel_size.value_or(0.2),  // mm
                           .max_memory = files.max_memory};
  std::vector<std::string> warnings;
  Bodies jaws{build_with_progress("upper jaw", make_jaw(Jaw::kUpper, 1), build, warnings),
              build_with_progress("lower jaw", make_jaw(Jaw::kLower, 1), build, warnings),
              build.spheres};
  print_warnings(warnings);
  return jaws;
}

// The ways refer to the trees.
std::vector<BenchWay> ways_to_ask(const SphereTree& fixed, const SphereTree& moving) {
  std::vector<BenchWay> ways;
  for (const SpherePolicy policy : kSpherePolicies) {
    if (!fixed.has(policy) || !moving.has(policy)) continue;
    const std::size_t published = ways.size();
    for (const int workers : {0, 1, 2}) {  // 0: the published query
      const EngineOptions options{.policy = policy, .workers = std::max(workers, 1)};
      const auto made =
          std::make_shared<Engine>(kEngineNames[workers == 0], fixed, moving, options);
      ways.push_back({"leaf pairs", workers == 0 ? "published" : "IST",
                      std::string(to_string(policy)), options.workers, published,
                      [=](const auto& pose) { return made->ask(pose).result.leaf_pairs; }});
    }
  }
  if (fixed.triangles() == nullptr || moving.triangles() == nullptr) return ways;
  const auto add = [&](const char* question, auto ask) {
    const auto query = std::make_shared<Query>(fixed, moving);
    ways.push_back({question, "IST", "", 1, {}, [=](const auto& pose) mutable {
                      query->forget();  // no answer depends on the pose before
                      return ask(*query, pose);
                    }});
  };
  add("touch", [](auto& query, auto& pose) { return (void)query.intersects(pose), Listed(); });
  add("distance", [](auto& query, auto& pose) { return (void)query.distance(pose, 0), Listed(); });
  std::vector<TrianglePair> room(1 << 20);
  add("triangle pairs", [room](auto& query, auto& pose) mutable {
    return Listed(query.triangle_pairs(pose, room).triangle_pairs);
  });
  return ways;
}

// Asks every way at each pose, in turns. The first turn fills the caches and is not timed.
void take_turns(std::vector<BenchWay>& ways, const std::vector<Eigen::Isometry3d>& poses,
                double seconds) {
  using Clock = std::chrono::steady_clock;
  constexpr int kLeastTurns = 4;
  ProgressBar bar;
  const Proceed show = shown_by(bar, "timing every way to ask");
  const auto start = Clock::now();
  const auto passed = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count() / seconds;
  };
  double ways_asked = 0;
  for (int turn = 0; turn < kLeastTurns || passed() < 1; ++turn) {
    for (BenchWay& way : ways) {
      const double turns = ways_asked++ / static_cast<double>(ways.size());
      show(std::min({1.0, turns / kLeastTurns, passed()}));
      for (const auto& pose : poses) {
        const auto begin = Clock::now();
        const Listed listed = way.ask(pose);
        const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
        if (turn > 0) way.times.push_back(time.count());
        if (turn == 0 && listed) way.listed = way.listed.value_or(0) + *listed;
      }
    }
  }
  for (BenchWay& way : ways) std::ranges::sort(way.times);
}

void run(const BenchArguments& options) {
  const auto& [files, poses, seconds, json] = options;
  refuse_if(!(seconds > 0 && seconds <= 3600), "--seconds", "give a positive number, 3600 at most");
  refuse_if(files.fixed.empty() != files.moving.empty(), "FIXED, MOVING",
            "give both bodies, or none for the built-in jaws");
  const Bodies bodies = files.fixed.empty() ? built_in_jaws(files) : load_bodies(files);
  const auto at =
      poses.empty() ? find_closing_way(bodies.fixed, bodies.moving, "").poses() : read_poses(poses);
  std::vector<BenchWay> ways = ways_to_ask(bodies.fixed, bodies.moving);
  take_turns(ways, at, seconds);
  NamedFiles named;
  if (!files.fixed.empty()) named = {{"fixed", files.fixed}, {"moving", files.moving}};
  if (json) print_header("bench", named);
  if (!json)
    fmt::print(
        "question       by        bounds  workers     pairs median µs      90 %      99 %  "
        "ratio\n");
  const std::string line =
      json ? R"({{"question":"{}","way":"{}","spheres":"{}","workers":{},"listed":{},)"
             R"("microseconds_median":{:.3f},"microseconds_p90":{:.3f},"microseconds_p99":{:.3f},)"
             R"("samples":{},"times":{}}})"
           : "{0:<15}{1:<10}{2:<7}{3:>8}{4:>10}{5:>10.2f}{6:>10.2f}{7:>10.2f}{9:>7}";
  for (const BenchWay& way : ways) {
    std::string listed = json ? "null" : "", times = listed;
    if (way.listed) listed = std::to_string(*way.listed);
    if (way.over) times = fmt::format("{:.2f}", ways[*way.over].quantile(0.5) / way.quantile(0.5));
    fmt::print(fmt::runtime(line + '\n'), way.question, way.way, way.spheres, way.workers, listed,
               way.quantile(0.5), way.quantile(0.9), way.quantile(0.99), way.times.size(), times);
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bench", "Time every way to ask on this machine");
  const auto options = std::make_shared<BenchArguments>();
  auto& [files, poses, seconds, json] = *options;
  add_file(*command, "FIXED", files.fixed, "body that stays; by default a jaw");
  add_file(*command, "MOVING", files.moving, "body that is moved");
  command->add_option("--voxel-size", files.voxel_size, "mesh units");
  add_file(*command, "--poses", poses, "JSON file; by default 12 of a closing");
  command->add_option("--seconds", seconds, "time for all turns")->capture_default_str();
  add_units_and_frame(*command, files);
  add_max_memory(*command, files.max_memory);
  command->add_flag("--json", json, "print one JSON object a line");
  add_example(*command, "Example: ist bench upper.stl lower.stl --voxel-size 0.4 --json");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
