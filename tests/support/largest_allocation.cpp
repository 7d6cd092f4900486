#include "support/largest_allocation.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> largest{0}, held{0}, peak{0};

void raise(std::atomic<std::size_t>& most, std::size_t bytes) noexcept {
  std::size_t known = most.load();
  while (known < bytes && !most.compare_exchange_weak(known, bytes)) {
  }
}

void* allocate(std::size_t bytes) noexcept {
  raise(largest, bytes);
  void* memory = std::malloc(bytes != 0 ? bytes : 1);
  const std::size_t given = malloc_usable_size(memory);
  raise(peak, held.fetch_add(given) + given);
  return memory;
}

void release(void* memory) noexcept {
  held -= malloc_usable_size(memory);
  std::free(memory);
}
}  // namespace

void* operator new(std::size_t bytes) {
  void* memory = allocate(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

namespace ist::test {

std::size_t largest_allocation(const std::function<void()>& action) {
  largest = 0;
  action();
  return largest;
}

std::size_t peak_allocation(const std::function<void()>& action) {
  const std::size_t before = held;
  peak = before;
  action();
  return peak - before;
}

}  // namespace ist::test
