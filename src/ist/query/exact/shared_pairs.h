#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "ist/query/exact/cluster_search.h"
#include "ist/query/exact/pair_list.h"
#include "ist/query/exact/triangle_visitors.h"
#include "ist/query/workers/resident_worker.h"
#include "ist/query/workers/split_queue.h"

namespace ist {

/// A search for all pairs of triangles that the resident worker helps with when it is awake and the
/// work is worth it. The caller goes down to the moving nodes above clusters, and cuts these into
/// chunks. It does the chunks from the front, and the worker from the back, into its own memory.
/// Pairs are sorted at last, so the answer is that of one worker.
///
/// A worker that is late is dropped, as for SharedSearch.
class SharedPairs {
 public:
  /// Reserves the memory of a ClusterSearch, and 3 MB.
  SharedPairs(const TriangleClusters& fixed, const TriangleClusters& moving,
              const ClusterKernels& kernels, std::chrono::nanoseconds period);
  ~SharedPairs();
  SharedPairs(const SharedPairs&) = delete;
  SharedPairs& operator=(const SharedPairs&) = delete;

  /// Searches at the pose of `search`, as that does for `all`, whose list is `list`. With a limit
  /// of tests the caller searches alone. Returns false where the budget ended the search.
  bool run(ClusterSearch& search, const Meshes& meshes, BudgetMeter& meter, AllPairs<PairList>& all,
           PairList& list) noexcept;

  [[nodiscard]] const Sharing& sharing() const noexcept { return sharing_; }
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Returns the bytes that it reserves for these clusters: what bytes() is of it.
  [[nodiscard]] static std::size_t bytes_for(const TriangleClusters& fixed,
                                             const TriangleClusters& moving) noexcept;

 private:
  // The worker's result for a chunk.
  struct Part {
    std::size_t begin, count;  // of its pairs
    std::uint64_t tests;
    bool whole;  // there was room for them
  };
  // The worker's pairs.
  struct Found {
    std::vector<TrianglePair> pairs;
    std::size_t count = 0;

    void add(TrianglePair pair) noexcept {
      if (count < pairs.size()) pairs[count] = pair;
      ++count;
    }
  };
  // A task whose nodes are in the memory of all.
  struct Task {
    std::uint32_t moving;
    int fixed_level;
    std::size_t first, count;
  };
  class Tasks;

  [[nodiscard]] ClusterTask task(std::size_t index) const noexcept;
  template <class Visitor>
  bool do_chunk(std::size_t chunk, ClusterSearch& search, BudgetMeter& meter,
                Visitor& visitor) const noexcept;
  void cut() noexcept;
  [[nodiscard]] bool do_chunks(ClusterSearch& search, BudgetMeter& meter, AllPairs<PairList>& all,
                               PairList& list) noexcept;
  void help() noexcept;

  const ClusterKernels& kernels_;
  std::chrono::nanoseconds period_;
  std::vector<std::uint32_t> nodes_;  // of all tasks
  std::vector<Task> tasks_;
  std::size_t node_count_ = 0, task_count_ = 0;
  std::vector<std::size_t> chunk_ends_;  // the task after the last one of each chunk
  std::size_t chunk_count_ = 0;
  SplitQueue queue_;
  std::uint64_t epoch_ = 0;
  // The worker's.
  ClusterSearch helper_;
  std::optional<Meshes> meshes_;
  FoundMemory memory_;
  Found found_;
  std::vector<Part> parts_;
  Sharing sharing_;
  Job job_;
  ResidentWorker worker_;
};

}  // namespace ist
