#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/tree_parts.h"
#include "seed/sections.h"
#include "support/bodies.h"
#include "support/effort.h"
#include "support/rounds.h"

namespace ist::bench {
namespace {

constexpr std::size_t kContacts = 1 << 20;

template <class Query, class... Options>
AxisDirection way(const std::string& name, const std::string& answers, double voxel_size,
                  const Options&... options) {
  const auto& [fixed, moving] = trees(voxel_size);
  const auto query = std::make_shared<Query>(fixed, moving, options...);
  const auto leaf_pairs = std::make_shared<std::vector<LeafPair>>(kContacts);
  return {name, answers,
          [=](const Eigen::Isometry3d& pose) { return query->leaf_pairs(pose, *leaf_pairs); }};
}

Place at(double distance) { return {fmt::format("{:g}", distance), closing(-distance)}; }

// The article's first proposal: spheres that are saved, against spheres made at each visit.
void add_saved(double voxel_size) {
  constexpr SpherePolicy kImplicit[] = {SpherePolicy::kSimple, SpherePolicy::kTable};
  std::vector<std::string> names;
  for (const SpherePolicy policy : kImplicit) {
    for (const char* source : {"on_the_fly", "saved"}) {
      names.push_back(fmt::format("{}/{}", to_string(policy), source));
    }
  }
  Rounds::add(
      fmt::format("saved/{:g}", voxel_size), names, {at(0), at(1.5)},
      [=] {
        std::vector<AxisDirection> ways;
        for (std::size_t i = 0; i < names.size(); ++i) {
          const SpherePolicy policy = kImplicit[i / 2];
          ways.push_back(
              way<ReferenceQuery>(names[i], std::string(to_string(policy)), voxel_size, policy,
                                  i % 2 == 0 ? SphereSource::kOnTheFly : SphereSource::kSaved));
        }
        return ways;
      },
      rounds(31),
      [=](benchmark::State& state, const QueryResult&) {
        const auto& [fixed, moving] = trees(voxel_size);
        const auto nodes = static_cast<double>(parts_of(fixed).octree.node_count() +
                                               parts_of(moving).octree.node_count());
        state.counters["ball_bytes"] = sizeof(Ball);
        state.counters["saved_MB"] = sizeof(Ball) * nodes / 1e6;
        state.counters["octree_MB"] =
            static_cast<double>(parts_of(fixed).octree.bytes() + parts_of(moving).octree.bytes()) /
            1e6;
      });
}

constexpr double kDistances[] = {0, 0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 7.5, 10, 15, 20, 25, 30, 40, 50};

// Which of the distances is right before collision: the first at which no triangles meet.
void add_before_contact(const std::string& name, double unit) {
  benchmark::RegisterBenchmark(("before_contact/" + name).c_str(), [=](benchmark::State& state) {
    const auto& [fixed, moving] = triangle_trees(0.8);  // triangles meet whatever the voxels
    Query query(fixed, moving);
    const double* apart = nullptr;
    for (auto _ : state) {
      apart = std::ranges::find_if(kDistances, [&](double distance) {
        return query.intersects(closing(-distance * unit)).answer == Answer::kNo;
      });
    }
    if (apart == std::end(kDistances)) {
      state.SkipWithError("the jaws meet at every distance");
      return;
    }
    state.counters["distance"] = *apart;
    state.SetLabel(pair_name());
  })->Iterations(1);
}

// Figure 10: by distance, policy and engine; distances in units of which there are `unit` mm.
void add_rate(const std::string& name, double voxel_size, double unit, int turns) {
  std::vector<Place> places;
  for (const double distance : kDistances) {
    places.push_back({fmt::format("{:g}", distance), closing(-distance * unit)});
  }
  std::vector<std::string> names;
  for (const char* engine : {"reference", "fast"}) {
    for (const SpherePolicy policy : kSpherePolicies) {
      names.push_back(fmt::format("{}/{}", engine, to_string(policy)));
    }
  }
  Rounds::add(
      fmt::format("rate/{}", name), names, places,
      [=] {
        std::vector<AxisDirection> ways;
        for (const SpherePolicy policy : kSpherePolicies) {
          const std::string& of = names[ways.size()];
          ways.push_back(way<ReferenceQuery>(of, of, voxel_size, policy));
        }
        for (const SpherePolicy policy : kSpherePolicies) {
          const std::string& of = names[ways.size()];
          QueryOptions options;
          options.policy = policy;
          ways.push_back(way<Query>(of, of, voxel_size, options));
        }
        return ways;
      },
      turns);
}

}  // namespace

void add_rates() {
  const double unit = published_unit();
  for (const double size : {0.8, 0.2}) {
    add_saved(size);
    add_rate(fmt::format("{:g}", size), size, 1, rounds(size < 0.5 ? 31 : 101));
    add_before_contact(fmt::format("{:g}", size), 1);
    if (quick()) continue;
    add_rate(fmt::format("scaled{:g}", size), size * unit, unit, rounds(31));
    add_before_contact(fmt::format("scaled{:g}", size), unit);
  }
}

}  // namespace ist::bench
