// How many poses a second a sweep answers, by threads, beside loops over the single calls in C and
// in Python: all in turns, about the same poses.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "ist/capi/ist_c.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/stopwatch.h"
#include "sweep/sweep.h"

namespace ist::bench {
namespace {

constexpr std::uint64_t kPoses = 5000;  // of a round
constexpr double kTolerance = 0.01;
constexpr double kVoxelSize = 0.4;
// Of the poses' box: mm to each side, mm that the lower jaw is lower at most, degrees about each
// axis.
constexpr double kBeside = 1, kBelow = 3, kTurned = 3;

[[noreturn]] void fail(const std::string& what) {
  std::cerr << what << '\n';
  std::exit(1);
}

// A folder with two trees and a sweep of them, removed at the end.
class Job {
 public:
  explicit Job(int rounds)
      : folder_(std::filesystem::temp_directory_path() /
                fmt::format("ist-sweep-bench-{}", ::getpid())) {
    std::filesystem::create_directory(folder_);
    const auto& [upper, lower] = triangle_trees(kVoxelSize);
    write_tree(upper, folder_ / "upper.ist");
    write_tree(lower, folder_ / "lower.ist");
    std::ofstream(file()) << fmt::format(R"(answers = ["intersects", "distance"]
tolerance = {0}
rows_per_part = {1}
[fixed]
tree = "upper.ist"
[moving]
tree = "lower.ist"
[poses.box]
seed = 1
count = {2}
from = [-{3}, -{3}, -{4}]
to = [{3}, {3}, 0]
turns_within = [{5}, {5}, {5}]
)",
                                         kTolerance, kPoses, kPoses * static_cast<unsigned>(rounds),
                                         kBeside, kBelow, kTurned);
  }
  ~Job() { std::filesystem::remove_all(folder_); }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "job.toml"; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

// The library's query, asked as a program in C asks it.
class LoopInC {
 public:
  explicit LoopInC(const Job& job) {
    need(ist_tree_load((job.folder() / "upper.ist").c_str(), nullptr, &fixed_));
    need(ist_tree_load((job.folder() / "lower.ist").c_str(), nullptr, &moving_));
    need(ist_query_create(fixed_, moving_, nullptr, &query_));
  }
  ~LoopInC() {
    ist_query_free(query_);
    ist_tree_free(moving_);
    ist_tree_free(fixed_);
  }
  LoopInC(const LoopInC&) = delete;
  LoopInC& operator=(const LoopInC&) = delete;

  void ask(const Eigen::Isometry3d& pose) {
    std::int32_t answer = 0;
    ist_distance_result distance{};
    distance.struct_size = sizeof(distance);
    need(ist_query_forget(query_));
    need(ist_query_intersects(query_, pose.data(), nullptr, &answer));
    need(ist_query_forget(query_));
    need(ist_query_distance(query_, pose.data(), kTolerance, nullptr, &distance));
  }

 private:
  static void need(ist_status status) {
    if (status != IST_OK) fail(ist_last_error_message());
  }

  ist_tree *fixed_ = nullptr, *moving_ = nullptr;
  ist_query* query_ = nullptr;
};

// Runs the same loop in Python, which prints the seconds that it took.
double seconds_in_python(const Job& job, std::uint64_t first) {
  const std::string command = fmt::format(
      "IST_LIBRARY='{}' PYTHONPATH='{}/src/python' /usr/bin/python3 -B "
      "'{}/bench/python/sweep_loop.py' '{}' {} {}",
      IST_SHARED_LIBRARY, IST_SOURCE_DIR, IST_SOURCE_DIR, job.file().string(), first, kPoses);
  std::FILE* const said = ::popen(command.c_str(), "r");
  double seconds = 0;
  const bool read = said != nullptr && std::fscanf(said, "%lf", &seconds) == 1;
  if (said == nullptr || ::pclose(said) != 0 || !read) {
    fail("the loop in Python failed: scripts/setup.sh --python");
  }
  return seconds;
}

std::vector<std::size_t> thread_counts() {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::size_t> counts;
  for (std::size_t count = 1; count < cores; count *= 2) counts.push_back(count);
  counts.push_back(cores);
  return counts;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure(benchmark::State& state) {
  const int rounds_made = rounds(7);
  const Job job(rounds_made + 1);
  const Sweep sweep(job.file());
  LoopInC in_c(job);
  std::vector<Eigen::Isometry3d> poses(kPoses);
  std::map<std::string, std::vector<double>> rates;  // poses a second
  const auto add = [&](const std::string& way, double seconds) {
    rates[way].push_back(static_cast<double>(kPoses) / seconds);
  };
  for (auto _ : state) {
    // The first round loads the trees and is not counted.
    for (int round = 0; round <= rounds_made; ++round) {
      const auto part = static_cast<std::uint64_t>(round);
      for (const std::size_t threads : thread_counts()) {
        const SweepFolder folder(job.folder() / fmt::format("threads-{}", threads),
                                 sweep.identity(), sweep.layout(), SweepFolder::Access::kWrite);
        const Stopwatch watch;
        sweep.run_part(folder, part, threads);
        if (round > 0) add(fmt::format("threads_{}", threads), 1e-3 * watch.milliseconds());
      }
      sweep.poses(part * kPoses, poses);
      const Stopwatch watch;
      for (const Eigen::Isometry3d& pose : poses) in_c.ask(pose);
      if (round > 0) add("loop_in_c", 1e-3 * watch.milliseconds());
      const double seconds = seconds_in_python(job, part * kPoses);
      if (round > 0) add("loop_in_python", seconds);
    }
    state.SetIterationTime(static_cast<double>(kPoses) / median(rates["threads_1"]));
  }
  for (const auto& [way, values] : rates) state.counters[way] = median(values);
  state.counters["poses"] = static_cast<double>(kPoses);
  state.counters["rounds"] = rounds_made;
  state.counters["tolerance"] = kTolerance;
  state.counters["voxel_size"] = kVoxelSize;
  state.counters["beside_mm"] = kBeside;
  state.counters["below_mm"] = kBelow;
  state.counters["turned_degrees"] = kTurned;
  state.counters["row_bytes"] = static_cast<double>(sweep.layout().bytes);
  state.SetLabel(pair_name());
}
BENCHMARK(measure)
    ->Name("sweep/rates")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);

}  // namespace
}  // namespace ist::bench
