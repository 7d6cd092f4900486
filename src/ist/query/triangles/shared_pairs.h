#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "ist/query/triangles/cluster_search.h"
#include "ist/query/triangles/pair_list.h"
#include "ist/query/triangles/triangle_visitors.h"
#include "ist/query/workers/shared_work.h"

namespace ist {

/// A search for all pairs of triangles that the resident worker helps with. The caller goes down to
/// the moving nodes above clusters, and cuts these into chunks. Pairs are sorted at last, so the
/// answer is the answer of one worker.
class SharedPairs {
 public:
  /// Reserves the memory of a ClusterSearch, and 3 MB.
  SharedPairs(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, std::chrono::nanoseconds period);

  /// Searches for `all` pairs at the pose of `search`, and adds them to `list`. If tests are
  /// limited, the caller searches alone. Returns false if the budget ended the search.
  bool run(ClusterSearch& search, const Meshes& meshes, BudgetMeter& meter, AllPairs& all,
           PairList& list) noexcept;

  [[nodiscard]] const Sharing& sharing() const noexcept { return work_.sharing(); }
  /// Returns the bytes that it reserves for these clusters.
  [[nodiscard]] static std::size_t bytes_for(const TriangleClusters& fixed,
                                             const TriangleClusters& moving) noexcept;

 private:
  struct Part {
    std::size_t begin, count;
    std::uint64_t tests;
    bool whole;
  };
  // Takes the tasks of a search, as far as there is room: a visitor of a ClusterSearch.
  struct Tasks {
    static constexpr bool kMostFirst = false, kMeasuresRest = false;
    [[nodiscard]] float reach() const noexcept { return within; }
    bool take(const ClusterTask& task) noexcept;

    std::vector<std::uint32_t> nodes;  // of all tasks
    std::vector<ClusterTask> list;
    std::size_t node_count = 0, count = 0;
    float within = 0;
    bool full = false;
  };

  // Searches some tasks. Returns whether the search came to its end.
  bool run(SharedWork<Part>::Items tasks, ClusterSearch& search, BudgetMeter& meter,
           AllPairs& all) const noexcept;
  void help(std::size_t chunk, Part& part) noexcept;

  const ClusterKernels& kernels_;
  // The worker reads these.
  Tasks tasks_;
  std::optional<Meshes> meshes_;
  // The worker's own.
  ClusterSearch helper_;
  FoundMemory memory_;
  std::vector<TrianglePair> found_;
  SharedWork<Part> work_;  // the last
};

}  // namespace ist
