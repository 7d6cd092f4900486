#include "ist/query/workers/resident_pool.h"

#include <chrono>

#include "ist/base/platform/pause.h"

namespace ist {

ResidentPool::Helper::Helper(ResidentPool& of, std::size_t at)
    : pool(of),
      thread(at),
      job(
          [](void* self) noexcept {
            const Helper& helper = *static_cast<Helper*>(self);
            helper.pool.work(helper.thread);
          },
          this),
      worker(at - 1) {}

ResidentPool::ResidentPool(std::size_t helpers, void* owner, Item item)
    : owner_(owner), item_(item) {
  for (std::size_t k = 1; k <= helpers; ++k) {
    helpers_.push_back(std::make_unique<Helper>(*this, k));
  }
}

void ResidentPool::run(std::size_t count) noexcept {
  count_ = count;
  next_.store(0, std::memory_order_relaxed);
  if (!helpers_.empty()) {
    helpers_.front()->worker.tick(std::chrono::steady_clock::now(), std::chrono::nanoseconds{0});
  }
  work(0);
  for (const auto& helper : helpers_) {
    if (!helper->offered) continue;
    helper->offered = false;
    if (helper->worker.retract(helper->job)) continue;
    while (helper->job.busy()) pause_briefly();
  }
}

void ResidentPool::work(std::size_t thread) noexcept {
  while (true) {
    if (thread == 0) offer();
    // Relaxed: a worker sees what the caller wrote by the offer, and the caller sees what a worker
    // wrote by the end of the job.
    const std::size_t k = next_.fetch_add(1, std::memory_order_relaxed);
    if (k >= count_) return;
    item_(owner_, thread, k);
  }
}

// Before each item, since a worker may begin to poll in the middle of a run.
void ResidentPool::offer() noexcept {
  for (const auto& helper : helpers_) {
    if (!helper->offered) helper->offered = helper->worker.offer(helper->job);
  }
}

}  // namespace ist
