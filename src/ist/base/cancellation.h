#pragma once

#include <atomic>

#include "ist/base/api.h"

namespace ist {

/// Lets another thread end long work of this one, as a cancellation point of POSIX threads does:
/// while an object lives and `asked` is true, cancellation_point() throws on the thread that made
/// the object. `asked` must outlive it. Objects on one thread nest.
class ScopedCancellation {
 public:
  explicit ScopedCancellation(const std::atomic<bool>& asked) noexcept;
  ~ScopedCancellation();
  ScopedCancellation(const ScopedCancellation&) = delete;
  ScopedCancellation& operator=(const ScopedCancellation&) = delete;

 private:
  const std::atomic<bool>* before_;
};

/// Returns whether this thread was asked to end. Cost: 2 ns.
[[nodiscard]] IST_LOOP_API bool is_cancelled() noexcept;

/// Throws kCancelled if this thread was asked to end. Readers and writers of files call it at each
/// face and each 4 MiB, readers of trees in memory at each array, a check of a mesh between its
/// parts, and the preparation of a world at each pair. Cost: 2 ns.
void cancellation_point();

}  // namespace ist
