#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "ist/base/api.h"

namespace ist {

/// Calls `body(begin, end)` on consecutive ranges that cover [0, count), on all cores. Each range
/// holds `grain` items, the last one possibly fewer. The ranges do not depend on the number of
/// threads, so a body that writes by range gives the same result for any number. Each range runs in
/// a ScopedFloatEnvironment. An exception of the body reaches the caller. The body may run a loop
/// of its own, even under a lock that other ranges wait for.
IST_LOOP_API void parallel_for(std::size_t count, std::size_t grain,
                               const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Sorts `keys` in ascending order, on all cores.
void parallel_sort(std::span<std::uint64_t> keys);

/// Limits parallel_for and parallel_sort to `threads` threads while this object lives.
class ScopedThreadLimit {
 public:
  explicit ScopedThreadLimit(std::size_t threads);
  ~ScopedThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Calls `run(context, 0)` … `run(context, ranges - 1)`, each once, on all cores. An exception
/// reaches the caller. Only parallel_for calls this function.
///
/// This function and the next ones are TBB's. In a build without TBB they are those of threads that
/// live as long as a loop, and in WebAssembly those of one thread.
void run_ranges(std::size_t ranges, void (*run)(void* context, std::size_t range), void* context);

/// Calls `run(context)` once on a thread of its own, concurrently with all loops, as soon as a
/// thread is free (even if loops are limited to one); never in WebAssembly, nor where the system
/// has no thread left. Returns at once. The call may begin while the process is ending, so
/// `context` and all objects that `run` uses must never be destroyed.
void run_aside(void (*run)(void* context), void* context);

/// Returns the number of threads that a loop uses by default, the caller's included: that of the
/// processors which it may run on.
[[nodiscard]] IST_LOOP_API std::size_t thread_count();

}  // namespace ist
