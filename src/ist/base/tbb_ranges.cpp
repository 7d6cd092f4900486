#include "ist/base/tbb_ranges.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace ist {

void tbb_ranges(std::size_t ranges, void (*run)(void*, std::size_t), void* context) {
  tbb::parallel_for(std::size_t{0}, ranges, [=](std::size_t range) { run(context, range); });
}

void tbb_aside(void (*run)(void*), void* context) {
  // An arena with no place but its caller's, who never comes: TBB lends such a one a worker for
  // what is enqueued, even where it is limited to one thread. It lives until its task has ended.
  tbb::task_arena arena(1, 1, tbb::task_arena::priority::high);
  arena.enqueue([=] { run(context); });
}

std::size_t tbb_threads() { return static_cast<std::size_t>(tbb::info::default_concurrency()); }

struct TbbThreadLimit::Control {
  tbb::global_control limit;
};

TbbThreadLimit::TbbThreadLimit(std::size_t threads)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, threads}}) {}
TbbThreadLimit::~TbbThreadLimit() = default;

}  // namespace ist
