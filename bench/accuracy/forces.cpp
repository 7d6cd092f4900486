#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "accuracy/approaches.h"
#include "accuracy/sections.h"
#include "loop/haptics/bodies/tool_contact_query.h"
#include "support/latencies.h"

namespace ist::bench {
namespace {

// mm, beyond the first contact: less than the finest voxel, for no depth is told beyond one.
constexpr double kDepths[] = {0.02, 0.05, 0.08};

// N for a stiffness of 1 N/mm, as a scene has it before anything is shared or clamped.
std::vector<Eigen::Vector3d> forces(double voxel_size, SpherePolicy policy) {
  const auto& [fixed, held] = trees(voxel_size);
  ToolContactOptions options;
  options.policy = policy;
  ToolContactQuery query(fixed, held, {1, {}, Eigen::Vector3d::Zero()}, options);
  std::vector<Eigen::Vector3d> found;
  ToolContacts contacts;
  for (const Approach& way : approaches()) {
    for (const double depth : kDepths) {
      const Placement tool = *Placement::from(way.pose(way.pair + depth));
      contacts.clear();
      static_cast<void>(query.find(tool, {}, contacts));
      found.push_back(contacts.spring.head<3>());
    }
  }
  return found;
}

// Those of the finest voxels, by the tightest bounds.
const std::vector<Eigen::Vector3d>& finest_forces() {
  static const std::vector<Eigen::Vector3d> found =
      forces(accuracy_sizes().back(), SpherePolicy::kSlab);
  return found;
}

void force(benchmark::State& state, double voxel_size, SpherePolicy policy) {
  constexpr double kDegrees = 57.29577951308232;
  Latencies lengths, angles;
  double none = 0;
  for (auto _ : state) {
    const std::vector<Eigen::Vector3d> found = forces(voxel_size, policy);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Eigen::Vector3d &f = found[i], &truth = finest_forces()[i];
      if (truth.norm() == 0) {
        state.SkipWithError("the finest voxels give no force");
        return;
      }
      lengths.add(std::abs(f.norm() / truth.norm() - 1));
      if (f.norm() == 0) {
        ++none;
      } else {
        angles.add(kDegrees * std::atan2(f.cross(truth).norm(), f.dot(truth)));
      }
    }
  }
  state.counters["length_p50"] = lengths.quantile(0.5);
  state.counters["length_max"] = lengths.quantile(1);
  if (angles.size() == 0) {
    state.SkipWithError("no pose has a force");
    return;
  }
  state.counters["angle_p50"] = angles.quantile(0.5);
  state.counters["angle_max"] = angles.quantile(1);
  state.counters["none"] = none;
  const auto [least, most] = std::minmax_element(std::begin(kDepths), std::end(kDepths));
  state.counters["least_depth_mm"] = *least;
  state.counters["most_depth_mm"] = *most;
  state.counters["n"] = static_cast<double>(lengths.size());
  state.SetLabel(pair_name());
}

}  // namespace

void add_forces() {
  for (const double size : accuracy_sizes()) {
    for (const SpherePolicy policy : kSpherePolicies) {
      benchmark::RegisterBenchmark(fmt::format("force/{:g}/{}", size, to_string(policy)).c_str(),
                                   [=](benchmark::State& state) { force(state, size, policy); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(1);
    }
  }
}

}  // namespace ist::bench
