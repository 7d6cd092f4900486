// The fast query along a closing: by voxel size, policy, instruction set and workers, back to back
// and paced at 1 kHz; and with the second worker stalled.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/shared_work.h"
#include "simd/dispatch.h"
#include "support/bodies.h"
#include "support/latencies.h"
#include "support/pacer.h"

namespace ist::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTick{1};
constexpr std::size_t kContacts = 1 << 20;

double microseconds(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double, std::micro>(end - begin).count();
}

// Ends the program where an engine is not what its scalar twin is: its time would mean nothing.
void check_against_twin(const SphereTree& fixed, const SphereTree& moving,
                        const QueryOptions& options, double dz) {
  QueryOptions plain = options;
  plain.target = "scalar";
  plain.workers = 1;
  Query query(fixed, moving, options), twin(fixed, moving, plain);
  std::vector<LeafPair> a(kContacts), b(kContacts);
  const QueryResult of_a = query.leaf_pairs(closing(dz), a), of_b = twin.leaf_pairs(closing(dz), b);
  a.resize(
      std::min<std::uint64_t>(a.size(), of_a.leaf_pairs));  // what lies behind them is no answer
  b.resize(std::min<std::uint64_t>(b.size(), of_b.leaf_pairs));
  if (of_a.leaf_pairs == of_b.leaf_pairs && of_a.sphere_tests == of_b.sphere_tests && a == b)
    return;
  std::cerr << "the query differs from its scalar twin at dz = " << dz << '\n';
  std::exit(1);
}

struct Case {
  double voxel_size;
  QueryOptions options;
  bool paced;
  int rounds;
};

// A case's queries, one after the other round the whole closing, so that no pose is asked twice in
// a row. All poses are measured together, when the first of them is to be reported.
class Closing {
 public:
  explicit Closing(Case c) : case_(std::move(c)) {}

  void report(benchmark::State& state, std::size_t pose) {
    for (auto _ : state) {
      if (leaf_pairs_.empty()) measure();
      state.SetIterationTime(1e-6 * latencies_[pose].quantile(0.5));
    }
    const QueryResult& result = results_[pose];
    latencies_[pose].report(state);
    state.counters["contacts"] = static_cast<double>(result.leaf_pairs);
    state.counters["tests"] = static_cast<double>(result.sphere_tests);
    state.counters["ns_a_test"] =
        1e3 * latencies_[pose].quantile(0.5) / static_cast<double>(result.sphere_tests);
    state.counters["query_MB"] = static_cast<double>(bytes_) / 1e6;
    if (case_.options.workers == 2) {
      state.counters["worth"] = static_cast<double>(sharing_.worth);
      state.counters["shared"] = static_cast<double>(sharing_.shared);
      state.counters["dropped"] = static_cast<double>(sharing_.dropped);
      state.counters["helper_share"] = helper_share_;
    }
    state.SetLabel(pair_name());
  }

 private:
  void measure() {
    const auto& [fixed, moving] = trees(case_.voxel_size);
    for (const double dz : kClosing) check_against_twin(fixed, moving, case_.options, dz);
    Query query(fixed, moving, case_.options);
    leaf_pairs_.resize(kContacts);
    Pacer pacer(kTick);
    const auto before = ResidentWorker::usage();
    for (int round = 0; round < case_.rounds; ++round) {
      for (std::size_t pose = 0; pose < std::size(kClosing); ++pose) {
        if (case_.paced) pacer.wait();
        const auto begin = Clock::now();
        results_[pose] = query.leaf_pairs(closing(kClosing[pose]), leaf_pairs_);
        latencies_[pose].add(microseconds(begin, Clock::now()));
      }
    }
    const auto after = ResidentWorker::usage();
    helper_share_ = static_cast<double>((after.cpu - before.cpu).count()) /
                    static_cast<double>((after.wall - before.wall).count());
    sharing_ = sharing_of(query);
    bytes_ = query.bytes();
  }

  Case case_;
  std::vector<LeafPair> leaf_pairs_;
  std::array<Latencies, std::size(kClosing)> latencies_;
  std::array<QueryResult, std::size(kClosing)> results_;
  Sharing sharing_;
  double helper_share_ = 0;
  std::size_t bytes_ = 0;
};

std::atomic<bool> stalled{false};

// The worker stands still for 50 ms at a time, wherever it is handed something; what the caller
// takes then, beside what it takes alone.
void worker_stalled(benchmark::State& state, double dz) {
  const auto& [fixed, moving] = trees(0.2);
  QueryOptions serial, helped;
  helped.workers = 2;
  helped.period = kTick;
  Query one(fixed, moving, serial), two(fixed, moving, helped);
  std::vector<LeafPair> leaf_pairs(kContacts);
  Latencies of_one, of_two;
  hand_over_hook.store([](HandOver) noexcept {
    stalled = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stalled = false;
  });
  Pacer pacer(kTick);
  std::size_t met = 0;
  for (auto _ : state) {
    pacer.wait();
    auto begin = Clock::now();
    static_cast<void>(one.leaf_pairs(closing(dz), leaf_pairs));
    of_one.add(microseconds(begin, Clock::now()));
    pacer.wait();
    begin = Clock::now();
    static_cast<void>(two.leaf_pairs(closing(dz), leaf_pairs));
    of_two.add(microseconds(begin, Clock::now()));
    if (stalled) ++met;
  }
  hand_over_hook.store(nullptr);
  state.counters["met_stalled"] = static_cast<double>(met);
  of_one.report(state, "one_");
  of_two.report(state, "stalled_");
  state.SetLabel(pair_name());
}

std::string number(double value) { return std::to_string(value).substr(0, value < 0 ? 4 : 3); }

void add(const Case& c) {
  const auto run = std::make_shared<Closing>(c);
  for (std::size_t pose = 0; pose < std::size(kClosing); ++pose) {
    const std::string name = "query/" + number(c.voxel_size) + "/" +
                             std::string(to_string(*c.options.policy)) + "/" +
                             (c.options.target.empty() ? "best" : c.options.target) + "/" +
                             std::to_string(c.options.workers) + (c.paced ? "/paced/" : "/row/") +
                             number(kClosing[pose]);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) { run->report(state, pose); })
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Iterations(1);
  }
}

QueryOptions options(SpherePolicy policy, int workers, std::string target = "") {
  QueryOptions options;
  options.policy = policy;
  options.workers = workers;
  options.target = std::move(target);
  return options;
}

const int kRegistered = [] {
  for (const double size : {0.8, 0.4, 0.2}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      for (const int workers : {1, 2}) {
        QueryOptions in_a_row = options(policy, workers);
        in_a_row.period = std::chrono::nanoseconds(0);
        add({size, in_a_row, false, 1000});
      }
    }
  }
  for (const int workers : {1, 2}) add({0.2, options(SpherePolicy::kSlab, workers), true, 1000});
  for (const Kernels& kernels : all_kernels()) {
    add({0.2, options(SpherePolicy::kSlab, 1, kernels.target), false, 100});
  }
  benchmark::RegisterBenchmark("worker_stalled/0.0",
                               [](benchmark::State& state) { worker_stalled(state, 0); })
      ->Iterations(1000)
      ->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
}  // namespace ist::bench
