// Queries where there is more to find than there is time for: what conformal bodies cost without a
// budget, and by how much a query with 100 µs runs over them, in the processor's time of its own
// thread, so that waiting for a core does not count. Interrupts do: beside each query stands a loop
// that does nothing but look at the clock until its own 100 µs are over. Leaf pairs and contacts
// are asked for; coarse and small bodies write many of them. Small bodies are asked within 1 ms as
// well.
//
//   unbudgeted/SCENE              the whole query
//   within_GIVENus/VERB/SCENE     by how much a query runs over what it is given
//
//   IST_DEADLINE_QUERIES   queries and loops a scene and verb within 100 µs, and a tenth of them
//                          within 1 ms; by default 50000
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/conformal.h"
#include "support/effort.h"
#include "support/latencies.h"

namespace ist::bench {
namespace {

using Clock = Budget::Clock;
constexpr double kVoxelSize = 0.2, kCoarse = 0.8;
// Facets of 0.7 mm: bodies as large as a jaw, and ones whose leaves are reached in time.
constexpr double kLarge = 40, kSmall = 5;
constexpr int kLargeLevel = 7, kSmallLevel = 4;
constexpr std::size_t kMostPairs = 1 << 20;

double thread_microseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

struct Scene {
  std::string name;
  std::pair<SphereTree, SphereTree> trees;
  std::vector<Eigen::Isometry3d> poses;  // asked in turn
};

// The pair's own place, and some a hundredth of a voxel beside it.
std::vector<Eigen::Isometry3d> places() {
  std::vector<Eigen::Isometry3d> poses(4, Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].translation().x() = 0.01 * kVoxelSize * static_cast<double>(i);
  }
  return poses;
}

Scene conformal(const test::ConformalPair& pair, const std::string& name) {
  return {name,
          {build(pair.fixed, kVoxelSize, SpherePolicy::kSlab),
           build(pair.moving, kVoxelSize, SpherePolicy::kSlab)},
          places()};
}

Scene jaws(const std::string& name, double voxel_size) {
  Scene scene{name,
              {build(upper_jaw(), voxel_size, SpherePolicy::kSlab),
               build(lower_jaw(), voxel_size, SpherePolicy::kSlab)},
              {}};
  for (const double dz : kClosing) scene.poses.push_back(closing(dz));
  return scene;
}

// A scene is there as long as it is measured.
using Make = std::function<Scene()>;
const Scene& made(const std::string& name, const Make& make) {
  static std::unique_ptr<Scene> last;
  if (last == nullptr || last->name != name) {
    last.reset();
    last = std::make_unique<Scene>(make());
  }
  return *last;
}

QueryOptions slabs() {
  QueryOptions options;
  options.policy = SpherePolicy::kSlab;
  return options;
}

void unbudgeted(benchmark::State& state, const std::string& name, const Make& make) {
  const Scene& scene = made(name, make);
  Query query(scene.trees.first, scene.trees.second, slabs());
  std::vector<LeafPair> leaf_pairs(kMostPairs);
  Latencies latencies;
  std::size_t turn = 0;
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(
        query.leaf_pairs(scene.poses[turn++ % scene.poses.size()], leaf_pairs));
    const std::chrono::duration<double> time = Clock::now() - begin;
    latencies.add(1e6 * time.count());
    state.SetIterationTime(time.count());
  }
  latencies.report(state);
  // Medians over the poses, as the time is.
  std::vector<double> tests, pairs;
  for (const auto& pose : scene.poses) {
    const QueryResult result = query.leaf_pairs(pose, leaf_pairs);
    tests.push_back(static_cast<double>(result.sphere_tests));
    pairs.push_back(static_cast<double>(result.leaf_pairs));
  }
  const auto median = [](std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  state.counters["leaves"] = static_cast<double>(scene.trees.first.leaf_count());
  state.counters["tests"] = median(tests);
  state.counters["pairs"] = median(pairs);
}

// Thread times of things that are to end at a deadline, over what they were given. A deadline is
// wall time: what was off its core for longer than this does not count, but is counted.
class Overruns {
 public:
  static constexpr double kAway = 2;  // µs

  template <class Run>
  void measure(std::chrono::microseconds given, const Run& run) {
    const auto wall = Clock::now();
    const double begin = thread_microseconds();
    run(wall + given);
    const double used = thread_microseconds() - begin;
    const std::chrono::duration<double, std::micro> passed = Clock::now() - wall;
    if (passed.count() - used > kAway) {
      ++away_;
    } else {
      over_.add(std::max(0.0, used - static_cast<double>(given.count())));
    }
  }

  void report(benchmark::State& state, const std::string& prefix) {
    if (over_.size() == 0) {
      state.SkipWithError("everything was off its core");
      return;
    }
    over_.report(state, prefix);
    state.counters[prefix + "p99.99_us"] = over_.quantile(0.9999);
    state.counters[prefix + "away"] = away_;
  }

 private:
  Latencies over_;
  double away_ = 0;
};

enum class Verb : std::uint8_t { kLeafPairs, kContacts };

void within(benchmark::State& state, std::chrono::microseconds given, Verb verb,
            const std::string& name, const Make& make) {
  const Scene& scene = made(name, make);
  Query query(scene.trees.first, scene.trees.second, slabs());
  ContactManifold manifold(scene.trees.first, scene.trees.second, SpherePolicy::kSlab,
                           {.margin = 2});
  std::vector<LeafPair> leaf_pairs(kMostPairs);
  Overruns of_query, of_loop;
  std::size_t turn = 0, complete = 0;
  double tests = 0, most_pairs = 0;
  for (auto _ : state) {
    const Eigen::Isometry3d& pose = scene.poses[turn++ % scene.poses.size()];
    QueryResult result;
    of_query.measure(given, [&](Clock::time_point deadline) {
      const Budget budget{.deadline = deadline};
      result = verb == Verb::kContacts ? query.contacts(pose, manifold, budget)
                                       : query.leaf_pairs(pose, leaf_pairs, budget);
    });
    of_loop.measure(given, [](Clock::time_point deadline) {
      while (Clock::now() < deadline) {
      }
    });
    complete += result.complete ? 1 : 0;
    tests += static_cast<double>(result.sphere_tests);
    most_pairs = std::max(most_pairs, static_cast<double>(result.leaf_pairs));
  }
  of_query.report(state, "over_");
  of_loop.report(state, "loop_");
  const auto queries = static_cast<double>(state.iterations());
  state.counters["complete"] = static_cast<double>(complete) / queries;
  state.counters["tests"] = tests / queries;
  state.counters["most_pairs"] = most_pairs;
  state.counters["away_us"] = Overruns::kAway;
  state.counters["n"] = queries;
}

std::int64_t queries() {
  const char* named = std::getenv("IST_DEADLINE_QUERIES");
  return named != nullptr ? std::atoll(named) : rounds(50'000);
}

void add(const std::string& name, const Make& make) {
  benchmark::RegisterBenchmark(("unbudgeted/" + name).c_str(),
                               [=](benchmark::State& state) { unbudgeted(state, name, make); })
      ->Iterations(20)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime();
  const auto add_within = [&](std::chrono::microseconds given, std::int64_t count) {
    for (const auto& [verb, verb_name] :
         {std::pair(Verb::kLeafPairs, "leaf_pairs"), std::pair(Verb::kContacts, "contacts")}) {
      benchmark::RegisterBenchmark(
          ("within_" + std::to_string(given.count()) + "us/" + verb_name + "/" + name).c_str(),
          [=, verb = verb](benchmark::State& state) { within(state, given, verb, name, make); })
          ->Iterations(count)
          ->Unit(benchmark::kMicrosecond);
    }
  };
  add_within(std::chrono::microseconds(100), queries());
  if (name.starts_with("small")) add_within(std::chrono::microseconds(1000), queries() / 10);
}

const int kRegistered = [] {
  const auto add_pair = [](const std::string& name,
                           const std::function<test::ConformalPair()>& of) {
    add(name, [=] { return conformal(of(), name); });
  };
  add("jaws", [] { return jaws("jaws", kVoxelSize); });
  add("coarse_jaws", [] { return jaws("coarse_jaws", kCoarse); });
  add_pair("shells/0.5", [] { return test::shell_in_shell(kLargeLevel, kLarge, 0.5); });
  add_pair("shells/0.05", [] { return test::shell_in_shell(kLargeLevel, kLarge, 0.05); });
  add_pair("peg/0.05", [] { return test::peg_in_hole(1 << kLargeLevel, kLarge, 0.05); });
  add_pair("plates/0.05", [] { return test::plates(2 * kLarge, 0.05); });
  add_pair("inside", [] { return test::one_inside(kLargeLevel, kLarge); });
  add_pair("small_shells/0.05", [] { return test::shell_in_shell(kSmallLevel, kSmall, 0.05); });
  add_pair("small_peg/0.05", [] { return test::peg_in_hole(1 << kSmallLevel, kSmall, 0.05); });
  add_pair("small_plates/0.05", [] { return test::plates(2 * kSmall, 0.05); });
  return 0;
}();

}  // namespace
}  // namespace ist::bench
