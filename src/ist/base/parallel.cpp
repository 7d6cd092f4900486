#include "ist/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"

namespace ist {

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  IST_ASSERT(grain > 0);
  const std::size_t ranges = (count + grain - 1) / grain;
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t range) {
    const ScopedFloatEnvironment environment;
    body(range * grain, std::min(count, (range + 1) * grain));
  });
}

void parallel_sort(std::span<std::uint64_t> keys) { tbb::parallel_sort(keys.begin(), keys.end()); }

struct ScopedThreadLimit::Control {
  tbb::global_control limit;
};

ScopedThreadLimit::ScopedThreadLimit(std::size_t threads)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, threads}}) {}
ScopedThreadLimit::~ScopedThreadLimit() = default;

}  // namespace ist
