#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "ist/base/parallel.h"

namespace ist {

void run_ranges(std::size_t ranges, void (*run)(void*, std::size_t), void* context) {
  // A thread that waits for its loop takes no range of an outer one. So a range may run a loop
  // while it holds a lock, or a std::once_flag, that other ranges wait for.
  tbb::this_task_arena::isolate([=] {
    tbb::parallel_for(std::size_t{0}, ranges, [=](std::size_t range) { run(context, range); });
  });
}

void run_aside(void (*run)(void*), void* context) {
  // The arena's only slot is reserved for a caller that never joins. TBB lends such an arena a
  // worker for enqueued tasks even if TBB is limited to one thread. The arena lives until its task
  // has ended.
  tbb::task_arena arena(1, 1, tbb::task_arena::priority::high);
  arena.enqueue([=] { run(context); });
}

std::size_t thread_count() { return static_cast<std::size_t>(tbb::info::default_concurrency()); }

struct ScopedThreadLimit::Control {
  tbb::global_control limit;
};

ScopedThreadLimit::ScopedThreadLimit(std::size_t threads)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, threads}}) {}
ScopedThreadLimit::~ScopedThreadLimit() = default;

}  // namespace ist
