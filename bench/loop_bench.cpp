// How late the ticks of the 1 kHz loop begin and how long they take, idle and beside a noisy
// neighbour, and how late this machine wakes a thread that has nothing else to do: the loop's own
// clock and a plain sleep. The whole distribution: quantiles, and how many times were no longer
// than each of a row of times. And what several bodies cost in a tick.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ist/scene.h"
#include "loop/haptics/bodies/pair_queries.h"
#include "loop/haptics/real_time.h"
#include "loop/haptics/tick_clock.h"
#include "loop/haptics/tool.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

// While it lives, as many threads as the machine has cores stream through kMegabytes each, which
// no core's own cache holds, and compute on it, at the priority of ordinary threads. Made before a
// thread asks for a higher one, which they would begin with.
class NoisyNeighbour {
 public:
  static constexpr std::size_t kMegabytes = 64;
  /// @param there whether there is one at all
  explicit NoisyNeighbour(bool there);
  ~NoisyNeighbour();
  NoisyNeighbour(const NoisyNeighbour&) = delete;
  NoisyNeighbour& operator=(const NoisyNeighbour&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::atomic<unsigned> at_work_{0};
  std::vector<std::thread> threads_;
};

NoisyNeighbour::NoisyNeighbour(bool there) {
  constexpr std::size_t kBlock = 4096, kBlocks = kMegabytes * 1'000'000 / sizeof(double) / kBlock;
  if (!there) return;
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < cores; ++i) {
    threads_.emplace_back([this] {
      std::vector<double> numbers(kBlocks * kBlock, 1.0);
      at_work_.fetch_add(1);
      for (std::size_t block = 0; !stop_.load(std::memory_order_relaxed); ++block) {
        double* const first = numbers.data() + block % kBlocks * kBlock;
        for (std::size_t n = 0; n < kBlock; ++n) first[n] = 0.75 * first[n] + 0.5;
      }
      benchmark::DoNotOptimize(numbers.data());
    });
  }
  while (at_work_.load() < cores) std::this_thread::yield();
}

NoisyNeighbour::~NoisyNeighbour() {
  stop_.store(true);
  for (std::thread& thread : threads_) thread.join();
}

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;
constexpr nanoseconds kPeriod = std::chrono::milliseconds(1);

double seconds() { return quick() ? 0.5 : 9; }
std::uint64_t ticks() { return static_cast<std::uint64_t>(1000 * seconds()); }

double microseconds(nanoseconds time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

// As `late_p99_us`, and for each of the times, six a decade, `late_upto_150us`.
void tell(benchmark::State& state, const std::string& what, const LatencyHistogram& times) {
  for (const double percent : {50.0, 90.0, 99.0, 99.9, 99.99}) {
    state.counters[fmt::format("{}_p{}_us", what, percent)] =
        microseconds(times.quantile(percent / 100));
  }
  state.counters[what + "_max_us"] = microseconds(times.max());
  for (const std::int64_t decade : {100, 1000, 10'000, 100'000, 1'000'000, 10'000'000}) {
    for (const std::int64_t tenths : {10, 15, 20, 30, 50, 70}) {
      const nanoseconds upto(decade * tenths / 10);
      state.counters[fmt::format("{}_upto_{}us", what, microseconds(upto))] =
          static_cast<double>(times.count_upto(upto));
    }
  }
  state.counters[what + "_count"] = static_cast<double>(times.count());
}

std::string joined(const std::vector<std::string>& notes) {
  return fmt::format("{}{}", pair_name(), notes.empty() ? "" : "; " + notes.front());
}

// A scene with springs in place of contact: leaf pairs are counted.
Scene with_springs(Scene scene) {
  scene.contact.reset();
  scene.friction.reset();
  scene.springs = SpringsSettings{.allow_breaking = true};
  return scene;
}

// The jaws of the scene of docs/haptics.md; or, where their files are missing, those that need
// none.
Scene scene_of_jaws() {
  const bool real = std::string(pair_name()) == "human";
  if (real) setenv("IST_DATA_DIR", data_file("").parent_path().c_str(), 0);
  return with_springs(read_scene(scene_file(real ? "human_pair.toml" : "jaws.toml")));
}

// They close in the first third, and are held closed for the rest.
Scene closing_scene(int workers) {
  Scene scene = scene_of_jaws();
  scene.seconds = seconds();
  scene.workers = workers;
  scene.fixed.front().voxel_size = scene.held.front().voxel_size = quick() ? 0.8 : 0.2;
  scene.proximity.reset();
  scene.gravity.reset();
  scene.snap.reset();
  std::vector<Waypoint>& plan = std::get<HandSettings>(scene.device).plan;
  plan.resize(2);
  plan[1].time = seconds() / 3;
  plan.push_back({1e6, plan[1].pose});
  return scene;
}

void loop(benchmark::State& state, int workers, bool noisy) {
  const Scene scene = closing_scene(workers);
  const BuiltScene built = build_scene(scene);
  ServoOptions options{};
  options.ticks = ticks();
  Snapshot<TickRecord> last;
  ServoOutputs outputs;
  outputs.snapshot = &last;
  const std::atomic<bool> stop{false};
  ServoReport report;
  for (auto _ : state) {
    const NoisyNeighbour neighbour(noisy);
    report = run_servo_loop(*built.simulation, *built.device, options, outputs, stop);
  }
  const TickRecord end = last.read();
  if (!end.contacts || end.contacts->leaf_pairs == 0 || report.faults > 0) {
    state.SkipWithError("the jaws are not closed at the end, or the loop had a fault");
    return;
  }
  tell(state, "late", report.late);
  tell(state, "execution", report.execution);
  tell(state, "cpu", report.cpu);
  state.counters["ticks"] = static_cast<double>(report.ticks);
  state.counters["missed"] = static_cast<double>(report.missed);
  state.counters["held"] = static_cast<double>(report.held);
  state.counters["contacts"] = static_cast<double>(end.contacts->leaf_pairs);
  state.counters["voxel_size"] = *scene.fixed.front().voxel_size;
  state.counters["period_us"] = microseconds(kPeriod);
  state.counters["awake_us"] = microseconds(TickClock::kLead);
  state.counters["neighbour_MB"] = static_cast<double>(NoisyNeighbour::kMegabytes);
  state.counters["denied"] = static_cast<double>(report.notes.size());
  state.SetLabel(joined(report.notes));
}

// A loop that does nothing: `wait` ends a tick and tells how the next began.
void bare(benchmark::State& state, bool real_time, bool noisy,
          const std::function<TickStart()>& wait) {
  LatencyHistogram late;
  std::uint64_t missed = 0;
  std::vector<std::string> notes;
  for (auto _ : state) {
    const NoisyNeighbour neighbour(noisy);
    std::optional<RealTimeThread> thread;
    if (real_time) thread.emplace(RealTimeOptions{});
    for (std::uint64_t tick = 0; tick < ticks(); ++tick) {
      const TickStart start = wait();
      late.record(start.late);
      missed += start.missed;
      tick += start.missed;
    }
    if (thread) notes = thread->notes();
  }
  tell(state, "late", late);
  state.counters["ticks"] = static_cast<double>(late.count());
  state.counters["missed"] = static_cast<double>(missed);
  state.counters["denied"] = static_cast<double>(notes.size());
  state.SetLabel(joined(notes));
}

// The loop's clock, by which it rises early and waits awake.
void bare_clock(benchmark::State& state, bool noisy) {
  TickClock clock(kPeriod);
  bool begun = false;
  bare(state, true, noisy, [&] {
    if (!begun) clock.start();
    begun = true;
    return clock.wait_for_next();
  });
}

// The same schedule, slept through to its very end: how late the machine wakes.
void bare_sleep(benchmark::State& state, bool real_time, bool noisy) {
  std::optional<TickSchedule> schedule;
  bare(state, real_time, noisy, [&] {
    if (!schedule) schedule.emplace(Clock::now(), kPeriod);
    std::this_thread::sleep_until(schedule->next(Clock::now()));
    return schedule->begin(Clock::now());
  });
}

// The shipped scene of a mandible that closes on a splint: four fixed bodies, each of which has a
// query with the held one.
class SplintPairs {
 public:
  SplintPairs()
      : scene_(with_springs(read_scene(scene_file("splint.toml")))), built_(build_scene(scene_)) {
    std::vector<BodyPart> parts;
    for (std::size_t i = 0; i < built_.trees.size(); ++i) {
      const bool held = i == scene_.fixed.size();
      const SceneBody& body = held ? scene_.held.front() : scene_.fixed[i];
      const SphereTree& tree = *built_.trees[i].contact;
      parts.push_back({body.name,
                       {body.rotation, scene_.unit * body.translation},
                       held ? built_.origin : tree.origin(),
                       scene_.unit * surface_radius(tree),
                       held});
    }
    const std::size_t held = scene_.fixed.size();
    const SceneBody& mandible = scene_.held.front();
    const Placement home{mandible.rotation,
                         scene_.unit * (mandible.rotation * built_.origin + mandible.translation)};
    bodies_ = HandBodies(scene_.unit, home, std::move(parts));
    for (std::size_t fixed = 0; fixed < held; ++fixed) {
      together_.add({fixed, held}, query(fixed, held));
      singly_.push_back(query(fixed, held));
    }
  }

  // The tool's poses in the ticks of a run without a clock.
  [[nodiscard]] std::vector<Placement> poses() const {
    std::vector<Placement> poses;
    while (!built_.device->done()) {
      const Tick tick = built_.simulation->tick(built_.device->read());
      built_.device->write(tick.wrench, built_.simulation->dt());
      poses.push_back(tick.tool);
    }
    return poses;
  }
  std::uint64_t ask_together(const Placement& tool) {
    return together_.find(bodies_, tool, {}, contacts_)->leaf_pairs;
  }
  std::uint64_t ask_one_by_one(const Placement& tool) {
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < singly_.size(); ++i) {
      alone_.clear();
      found += singly_[i]->find(tool, {}, alone_, 0).leaf_pairs;
    }
    return found;
  }

 private:
  [[nodiscard]] std::unique_ptr<ToolContactQuery> query(std::size_t fixed, std::size_t held) const {
    return std::make_unique<ToolContactQuery>(
        *built_.trees[fixed].contact, *built_.trees[held].contact, bodies_.frames(fixed, held),
        ToolContactOptions{.policy = SpherePolicy::kSlab, .margin = 0.25});
  }

  Scene scene_;
  BuiltScene built_;
  HandBodies bodies_;
  PairQueries together_;
  std::vector<std::unique_ptr<ToolContactQuery>> singly_;
  ToolContacts contacts_{4}, alone_;
};

// The queries of a tick with four fixed bodies, against the same pairs asked one by one, in turns.
void several_bodies(benchmark::State& state) {
  SplintPairs pairs;
  Latencies together, one_by_one, apart;
  std::uint64_t found = 0;
  for (auto _ : state) {
    const std::vector<Placement> poses = pairs.poses();
    const std::size_t step = quick() ? 40 : 1;
    bool first = true;
    for (std::size_t i = 0; i < poses.size(); i += step, first = !first) {
      std::uint64_t all = 0, sum = 0;
      double in_all = 0;
      const auto ask_all = [&] {
        const Stopwatch watch;
        all = pairs.ask_together(poses[i]);
        in_all = watch.microseconds();
      };
      if (first) ask_all();
      const Stopwatch watch;
      sum = pairs.ask_one_by_one(poses[i]);
      const double singly = watch.microseconds();
      if (!first) ask_all();
      if (all != sum) {
        state.SkipWithError("all pairs together are not the sum of each");
        return;
      }
      found += all;
      together.add(in_all);
      one_by_one.add(singly);
      if (all == 0) apart.add(in_all / 4);
    }
  }
  if (found == 0 || apart.size() == 0) {
    state.SkipWithError("nothing is near, or all always is");
    return;
  }
  together.report(state, "together_");
  one_by_one.report(state, "one_by_one_");
  apart.report(state, "apart_");
  state.counters["ratio"] = together.quantile(0.5) / one_by_one.quantile(0.5);
  state.counters["ticks"] = static_cast<double>(together.size());
  state.counters["ticks_apart"] = static_cast<double>(apart.size());
}

void add(const char* name, bool noisy, const std::function<void(benchmark::State&, bool)>& run) {
  benchmark::RegisterBenchmark(fmt::format("{}/{}", name, noisy ? "noisy" : "idle").c_str(),
                               [=](benchmark::State& state) { run(state, noisy); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(1);
}

const int kRegistered = [] {
  using State = benchmark::State;
  benchmark::RegisterBenchmark("bodies/splint", several_bodies)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
  for (const bool noisy : {false, true}) {
    add("loop/1", noisy, [](State& state, bool beside) { loop(state, 1, beside); });
    add("loop/2", noisy, [](State& state, bool beside) { loop(state, 2, beside); });
    add("bare/clock", noisy, bare_clock);
    add("bare/timer", noisy, [](State& state, bool beside) { bare_sleep(state, true, beside); });
    add("bare/plain", noisy, [](State& state, bool beside) { bare_sleep(state, false, beside); });
  }
  return 0;
}();

}  // namespace
}  // namespace ist::bench
