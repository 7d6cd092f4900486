#include "ist/base/tbb_ranges.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace ist {

void tbb_ranges(std::size_t ranges, void (*run)(void*, std::size_t), void* context) {
  tbb::parallel_for(std::size_t{0}, ranges, [=](std::size_t range) { run(context, range); });
}

struct TbbThreadLimit::Control {
  tbb::global_control limit;
};

TbbThreadLimit::TbbThreadLimit(std::size_t threads)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, threads}}) {}
TbbThreadLimit::~TbbThreadLimit() = default;

}  // namespace ist
