// What a world costs beside its queries: a tick of four bodies against the same pairs asked one by
// one, in turns; a pair that is apart; a hundred bodies at rest, and moving; a thousand that were
// just added.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <vector>

#include "ist/models/models.h"
#include "ist/query/world/world.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/latencies.h"
#include "support/stopwatch.h"

namespace ist::bench {
namespace {

constexpr double kVoxelSize = 0.4;
constexpr BodyIndex kFour = 4;
constexpr double kTremble = 0.05;  // voxels

Eigen::Isometry3d at(const Eigen::Vector3d& place) {
  return Eigen::Isometry3d(Eigen::Translation3d(place));
}

SphereTree shape(const TriangleMesh& mesh, double voxel_size) {
  return build_tree(mesh, {.voxel_size = voxel_size});
}

// Two jaws that bite, a ball that leans on the front teeth and a bar below the lower jaw.
struct FourBodies {
  FourBodies() {
    const auto& [upper, lower] = triangle_trees(kVoxelSize);
    const std::array trees = {upper, lower, shape(make_icosphere(4, 6), kVoxelSize),
                              shape(make_box({-30, -4, -4}, {30, 4, 4}), kVoxelSize)};
    places = {Eigen::Vector3d::Zero(), {0, 0, -1.5}, {0, -52, 48}, {0, -20, -20}};
    WorldOptions options;
    options.query.front_pairs = 1 << 15;
    world.emplace(options);
    for (const SphereTree& tree : trees) world->add(tree);
    world->reserve();
    for (BodyIndex a = 0; a < kFour; ++a) {
      for (BodyIndex b = a + 1; b < kFour; ++b) {
        pairs.push_back({a, b});
        queries.emplace_back(trees[a], trees[b], options.query);
        manifolds.emplace_back(trees[a], trees[b], queries.back().policy(), options.manifold);
      }
    }
  }

  // Moves all but the first body by up to a twentieth of a voxel.
  void tremble(int tick) {
    for (BodyIndex body = 1; body < kFour; ++body) {
      const double phase = 0.1 * tick + body;
      const Eigen::Vector3d by(std::sin(phase), std::cos(1.3 * phase), std::sin(0.7 * phase));
      poses[body] = at(places[body] + kTremble * kVoxelSize * by);
    }
  }
  void move() {
    for (BodyIndex body = 0; body < kFour; ++body) world->set_pose(body, poses[body]);
  }

  std::optional<World> world;
  std::vector<BodyPair> pairs;
  std::vector<Query> queries;
  std::vector<ContactManifold> manifolds;
  std::array<Eigen::Vector3d, kFour> places;
  std::array<Eigen::Isometry3d, kFour> poses = {at(Eigen::Vector3d::Zero())};
};

// A question that a world and queries are asked in turns.
struct Question {
  const char* name;
  std::function<std::uint64_t(FourBodies&)> of_world, one_by_one;
};

std::uint64_t ask_one_by_one(
    FourBodies& four,
    const std::function<std::uint64_t(std::size_t, const Eigen::Isometry3d&)>& ask) {
  std::uint64_t found = 0;
  for (std::size_t k = 0; k < four.pairs.size(); ++k) {
    const auto [a, b] = four.pairs[k];
    found += ask(k, four.poses[a].inverse() * four.poses[b]);
  }
  return found;
}

const std::array kQuestions = {
    Question{"contacts",
             [](FourBodies& four) {
               std::uint64_t found = 0;
               for (const auto& pair : four.world->ask({WorldQuestion::kContacts}).pairs) {
                 found += pair.found;
               }
               return found;
             },
             [](FourBodies& four) {
               return ask_one_by_one(four, [&](std::size_t k, const Eigen::Isometry3d& pose) {
                 return four.queries[k].contacts(pose, four.manifolds[k]).leaf_pairs;
               });
             }},
    Question{"intersects",
             [](FourBodies& four) {
               std::uint64_t found = 0;
               for (const auto& pair : four.world->ask({WorldQuestion::kIntersects}).pairs) {
                 found += pair.answer == Answer::kYes ? 1 : 0;
               }
               return found;
             },
             [](FourBodies& four) {
               return ask_one_by_one(four, [&](std::size_t k, const Eigen::Isometry3d& pose) {
                 return four.queries[k].intersects(pose).answer == Answer::kYes ? 1U : 0U;
               });
             }},
};

// Times both, in turns; which one is first changes from tick to tick.
void measure_four(benchmark::State& state, const Question& question) {
  static FourBodies four;
  Latencies of_world, one_by_one;
  for (auto _ : state) {
    const int ticks = rounds(3000);
    std::uint64_t in_world = 0, singly = 0;
    const auto world = [&] {
      const Stopwatch watch;
      four.move();
      in_world += question.of_world(four);
      of_world.add(watch.microseconds());
    };
    const auto queries = [&] {
      const Stopwatch watch;
      singly += question.one_by_one(four);
      one_by_one.add(watch.microseconds());
    };
    for (int tick = 0; tick < ticks; ++tick) {
      four.tremble(tick);
      if (tick % 2 == 0) {
        world();
        queries();
      } else {
        queries();
        world();
      }
    }
    if (in_world != singly || in_world == 0) {
      std::cerr << question.name << ": the world found " << in_world << ", queries " << singly
                << '\n';
      std::exit(1);
    }
    state.SetIterationTime(1e-6 * of_world.quantile(0.5));
  }
  of_world.report(state);
  one_by_one.report(state, "one_by_one_");
  state.counters["bodies"] = kFour;
  state.counters["pairs"] = static_cast<double>(four.pairs.size());
  state.counters["voxel_size"] = kVoxelSize;
  state.counters["tremble_voxels"] = kTremble;
  state.counters["ratio"] = of_world.quantile(0.5) / one_by_one.quantile(0.5);
  state.SetLabel(pair_name());
}

const SphereTree& small_ball() {
  static const SphereTree ball = shape(make_icosphere(3, 1), 0.1);
  return ball;
}

// Balls on a grid, `step` apart.
World grid(int count, double step) {
  World world;
  for (int i = 0; i < count; ++i) {
    world.add(small_ball(), at(step * Eigen::Vector3d(i % 5, i / 5 % 5, i / 25)));
  }
  world.reserve(static_cast<std::size_t>(count));
  return world;
}

// A tick in which `moved` bodies move.
void measure_grid(benchmark::State& state, int count, double step, int moved) {
  World world = grid(count, step);
  std::uint64_t near = 0;
  int tick = 0;
  for (auto _ : state) {
    ++tick;
    for (int i = 0; i < moved; ++i) {
      world.set_pose(static_cast<BodyIndex>(i),
                     at(step * Eigen::Vector3d(i % 5, i / 5 % 5, i / 25 + 0.001 * (tick % 2))));
    }
    near += world.ask({WorldQuestion::kNear}).near_pairs;
  }
  state.counters["bodies"] = count;
  state.counters["moved"] = moved;
  state.counters["near"] = static_cast<double>(near) / static_cast<double>(tick);
}

// A thousand balls of one tree, each in its neighbours: from the first add() to the first answer.
void measure_thousand(benchmark::State& state, std::size_t threads) {
  constexpr int kEdge = 10;
  static_cast<void>(small_ball());
  std::uint64_t bytes = 0, near = 0, touching = 0;
  for (auto _ : state) {
    World world({.threads = threads});
    for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
      world.add(small_ball(),
                at(1.9 * Eigen::Vector3d(i % kEdge, i / kEdge % kEdge, i / kEdge / kEdge)));
    }
    world.reserve(1 << 12);
    const WorldAnswer answer = world.ask({WorldQuestion::kIntersects});
    if (!answer.complete) state.SkipWithError("more pairs are near than expected");
    near = answer.near_pairs;
    touching = 0;
    for (const WorldPair& pair : answer.pairs) touching += pair.answer == Answer::kYes ? 1 : 0;
    bytes = world.bytes();
  }
  state.counters["bodies"] = kEdge * kEdge * kEdge;
  state.counters["threads"] = static_cast<double>(threads);
  state.counters["near"] = static_cast<double>(near);
  state.counters["touching"] = static_cast<double>(touching);
  state.counters["megabytes"] = 1e-6 * static_cast<double>(bytes);
}

void add_grid(const char* name, int count, double step, int moved) {
  benchmark::RegisterBenchmark(
      name, [=](benchmark::State& state) { measure_grid(state, count, step, moved); })
      ->Unit(benchmark::kMicrosecond)
      ->UseRealTime();
}

const bool kAdded = [] {
  for (const Question& question : kQuestions) {
    benchmark::RegisterBenchmark(fmt::format("world/four_bodies/{}", question.name).c_str(),
                                 [&](benchmark::State& state) { measure_four(state, question); })
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Iterations(1);
  }
  add_grid("world/a_pair_apart", 2, 10, 1);
  add_grid("world/a_pair_near_and_not_prepared", 2, 2, 1);
  add_grid("world/hundred_at_rest", 100, 10, 0);
  add_grid("world/hundred_moving", 100, 10, 100);
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}}) {
    benchmark::RegisterBenchmark(fmt::format("world/thousand_balls/threads_{}", threads).c_str(),
                                 [=](benchmark::State& state) { measure_thousand(state, threads); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace ist::bench
