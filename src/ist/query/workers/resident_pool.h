#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "ist/query/workers/resident_worker.h"

namespace ist {

/// Resident workers that help a caller with a list of items. Each item is done once, by the caller
/// or by a worker that is awake. The caller returns when all are done, so it may wait for an item
/// that a worker has begun.
///
/// run() allocates nothing, locks nothing and makes no system call. One pool belongs to one thread
/// at a time.
class ResidentPool {
 public:
  /// Does an item on a thread: 0 is the caller's, and `helpers` the last worker's.
  using Item = void (*)(void* owner, std::size_t thread, std::size_t item) noexcept;

  /// Reserves all memory. Precondition: helpers <= ResidentWorker::kMost.
  ResidentPool(std::size_t helpers, void* owner, Item item);

  /// Does the items 0 … count - 1, in this order as far as they begin.
  void run(std::size_t count) noexcept;

 private:
  struct Helper {
    Helper(ResidentPool& of, std::size_t at);
    ResidentPool& pool;
    std::size_t thread;
    bool offered = false;
    Job job;
    ResidentWorker worker;
  };
  // Does items until none is left.
  void work(std::size_t thread) noexcept;
  void offer() noexcept;

  void* owner_;
  Item item_;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::vector<std::unique_ptr<Helper>> helpers_;
};

}  // namespace ist
