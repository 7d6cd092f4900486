#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "accuracy/sections.h"
#include "query/contacts/closed_forms.h"

namespace ist::bench {
namespace {

// Bodies of some 4 mm whose radii of curvature are over ten of these.
constexpr double kSizes[] = {0.3, 0.15, 0.075};
// Voxels: how far apart, and how deep.
constexpr double kDepths[] = {-1.0, -0.5, 0.0, 0.25, 0.5, 0.75, 1.0};

void form(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  test::FormErrors all;
  for (auto _ : state) {
    for (const test::ClosedForm& form : test::closed_forms()) {
      const SphereTree fixed = test::tree_of_solid(form.fixed, voxel_size);
      const SphereTree moving = test::tree_of_solid(form.moving, voxel_size);
      for (const double depth : kDepths) {
        all.add(test::form_errors(form, fixed, moving, policy, depth));
      }
    }
  }
  if (!all.finite || all.smooth == 0) {
    state.SkipWithError("there are no contact points, or some that are no numbers");
    return;
  }
  state.counters["depth_mean"] = all.mean_depth() * voxel_size;
  state.counters["depth_max"] = all.depth * voxel_size;
  state.counters["normal_mean"] = all.mean_normal();
  state.counters["normal_max"] = all.normal;
  state.counters["n"] = static_cast<double>(all.smooth);
  const auto [least, most] = std::minmax_element(std::begin(kDepths), std::end(kDepths));
  state.counters["apart_voxels"] = -*least;
  state.counters["deep_voxels"] = *most;
  state.counters["forms"] = static_cast<double>(test::closed_forms().size());
}

}  // namespace

void add_forms() {
  for (const double size : kSizes) {
    if (quick() && size < 0.3) continue;
    for (const SpherePolicy policy : kSpherePolicies) {
      benchmark::RegisterBenchmark(fmt::format("form/{:g}/{}", size, to_string(policy)).c_str(),
                                   [=](benchmark::State& state) { form(state, size, policy); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
