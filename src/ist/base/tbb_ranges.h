#pragma once

#include <cstddef>
#include <memory>

namespace ist {

/// Calls `run(context, 0)` … `run(context, ranges - 1)`, each once, on all cores; an exception
/// reaches the caller. The seam to TBB: everything else calls parallel_for.
void tbb_ranges(std::size_t ranges, void (*run)(void* context, std::size_t range), void* context);

/// Calls `run(context)` once, on a thread of TBB's and beside all else that TBB does, as soon as it
/// has one to give, which it has even where it is limited to one; returns at once. It may begin
/// when the process is already ending: `context` and what `run` uses must outlive everything.
void tbb_aside(void (*run)(void* context), void* context);

/// How many threads TBB uses, the caller's included, where nothing bounds them.
[[nodiscard]] std::size_t tbb_threads();

/// Bounds TBB's threads while it lives.
class TbbThreadLimit {
 public:
  explicit TbbThreadLimit(std::size_t threads);
  ~TbbThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace ist
