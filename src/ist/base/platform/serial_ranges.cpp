// What tbb_ranges.cpp does, where there are no threads (WebAssembly): in the calling thread alone.

#include "ist/base/parallel.h"

namespace ist {

void run_ranges(std::size_t ranges, void (*run)(void*, std::size_t), void* context) {
  for (std::size_t range = 0; range < ranges; ++range) run(context, range);
}

void run_aside(void (*)(void*), void*) {}

std::size_t thread_count() { return 1; }

struct ScopedThreadLimit::Control {};

ScopedThreadLimit::ScopedThreadLimit(std::size_t) {}
ScopedThreadLimit::~ScopedThreadLimit() = default;

}  // namespace ist
