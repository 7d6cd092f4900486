#pragma once

#include <cstddef>
#include <memory>

namespace ist {

/// Calls `run(context, 0)` … `run(context, ranges - 1)`, each once, on all cores; an exception
/// reaches the caller. The seam to TBB: everything else calls parallel_for.
void tbb_ranges(std::size_t ranges, void (*run)(void* context, std::size_t range), void* context);

/// Calls `run(context)` once, on a thread of TBB's beside whatever else TBB does, as soon as it has
/// one to give; returns at once. It has one to give even where it is limited to a single thread.
void tbb_aside(void (*run)(void* context), void* context);

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
