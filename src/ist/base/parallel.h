#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "ist/base/tbb_ranges.h"

namespace ist {

/// Calls `body(begin, end)` on consecutive ranges that cover [0, count), on all cores. Ranges hold
/// `grain` items, the last one fewer: they do not depend on the number of threads, so a body that
/// writes by range gives the same result for any. Each range runs in ScopedFloatEnvironment. An
/// exception of the body reaches the caller.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Sorts ascending, on all cores.
void parallel_sort(std::span<std::uint64_t> keys);

/// Bounds the threads that the functions above use while this object lives.
class ScopedThreadLimit {
 public:
  explicit ScopedThreadLimit(std::size_t threads) : limit_(threads) {}
  ScopedThreadLimit(const ScopedThreadLimit&) = delete;
  ScopedThreadLimit& operator=(const ScopedThreadLimit&) = delete;

 private:
  TbbThreadLimit limit_;
};

}  // namespace ist
