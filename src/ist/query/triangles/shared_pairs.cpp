#include "ist/query/triangles/shared_pairs.h"

#include <algorithm>

namespace ist {
namespace {

// Fewer pairs of nodes above clusters, some 0.4 µs each, are not worth sharing. If there are more
// than the most, the caller searches alone.
constexpr std::size_t kFewestNodes = 192, kMostNodes = 1 << 16;
constexpr std::size_t kMostTasks = 1 << 13;
// The pairs of nodes of a chunk: some 5 µs of work.
constexpr std::size_t kChunkNodes = 16, kMostChunks = kMostNodes / kChunkNodes;
constexpr std::size_t kFoundPairs = 1 << 18;

}  // namespace

SharedPairs::SharedPairs(const TriangleClusters& fixed, const TriangleClusters& moving,
                         const ClusterKernels& kernels, std::chrono::nanoseconds period)
    : kernels_(kernels),
      tasks_{std::vector<std::uint32_t>(kMostNodes + kClusterWidth),
             std::vector<ClusterTask>(kMostTasks)},
      helper_(fixed, moving, kernels),
      found_(kFoundPairs),
      work_(kMostChunks, period, this, [](void* self, std::size_t chunk, Part& part) noexcept {
        static_cast<SharedPairs*>(self)->help(chunk, part);
      }) {}

bool SharedPairs::Tasks::take(const ClusterTask& task) noexcept {
  const std::size_t some = task.nodes.count;
  full = some > kMostNodes - node_count || count == list.size();
  if (full) return false;
  std::uint32_t* const codes = nodes.data() + node_count;
  std::copy_n(task.nodes.codes, some, codes);
  list[count++] = {task.moving, task.fixed_level, {codes, some}};
  node_count += some;
  return true;
}

bool SharedPairs::run(ClusterSearch& search, const Meshes& meshes, BudgetMeter& meter,
                      AllPairs& all, PairList& list) noexcept {
  work_.begin();
  if (meter.budget().has_tests() || work_.is_busy()) return search.run(meter, all);
  BudgetMeter above = meter;
  tasks_.node_count = tasks_.count = 0;
  tasks_.within = all.reach();
  tasks_.full = false;
  const bool whole = search.run(above, tasks_);
  if (tasks_.full) return search.run(meter, all);
  meter = above;
  if (!whole) return false;
  if (tasks_.node_count < kFewestNodes) return run({0, tasks_.count}, search, meter, all);
  work_.note_worth();
  helper_.begin(search.step().pose);
  meshes_.emplace(meshes);
  std::size_t nodes = 0;
  work_.cut(tasks_.count, kChunkNodes,
            [&](std::size_t i) { return nodes += tasks_.list[i].nodes.count; });
  return work_.run(
      meter.budget(),
      [&](std::size_t chunk) { return run(work_.items(chunk), search, meter, all); },
      [&](const Part& part) {
        for (std::size_t k = 0; k < part.count; ++k) list.add(found_[part.begin + k]);
        meter.spend(part.tests);
        return true;
      });
}

bool SharedPairs::run(SharedWork<Part>::Items tasks, ClusterSearch& search, BudgetMeter& meter,
                      AllPairs& all) const noexcept {
  for (std::size_t i = tasks.first; i < tasks.last; ++i) {
    if (!search.run(tasks_.list[i], meter, all)) return false;
  }
  return true;
}

void SharedPairs::help(std::size_t chunk, Part& part) noexcept {
  PairList list(0);
  list.begin(std::span(found_).subspan(part.begin));
  AllPairs all({helper_.step(), kernels_, *meshes_, memory_, {}}, list);
  BudgetMeter meter;
  run(work_.items(chunk), helper_, meter, all);
  all.finish();
  part.count = list.count();
  part.tests = meter.spent();
  part.whole = part.count <= found_.size() - part.begin;
}

std::size_t SharedPairs::bytes_for(const TriangleClusters& fixed,
                                   const TriangleClusters& moving) noexcept {
  return ClusterSearch::bytes_for(fixed, moving) + FoundMemory::bytes() +
         kFoundPairs * sizeof(TrianglePair) + (kMostNodes + kClusterWidth) * sizeof(std::uint32_t) +
         kMostTasks * sizeof(ClusterTask) + SharedWork<Part>::bytes_for(kMostChunks);
}

}  // namespace ist
