#include "support/largest_allocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> largest{0};

void* allocate(std::size_t bytes) noexcept {
  std::size_t known = largest.load();
  while (known < bytes && !largest.compare_exchange_weak(known, bytes)) {
  }
  return std::malloc(bytes != 0 ? bytes : 1);
}
}  // namespace

void* operator new(std::size_t bytes) {
  void* memory = allocate(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace ist::test {

std::size_t largest_allocation(const std::function<void()>& action) {
  largest = 0;
  action();
  return largest;
}

}  // namespace ist::test
