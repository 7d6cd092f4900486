#include "ist/query/workers/split_queue.h"

#include "ist/base/assert.h"
#include "ist/base/platform/pause.h"

namespace ist {
namespace {

// The word holds epoch, back and front; the free chunks are [front, back). 38 bits of epoch go
// round after a year and a half of 5000 epochs a second; only a helper that slept all that time
// could mistake one.
constexpr int kIndexBits = 13;
constexpr std::uint64_t kIndexMask = (1u << kIndexBits) - 1;
static_assert(SplitQueue::kMaxChunks <= kIndexMask);
constexpr std::uint64_t kOneFront = 1, kOneBack = std::uint64_t{1} << kIndexBits;
constexpr std::uint64_t kEpochMask = ~std::uint64_t{0} >> (2 * kIndexBits);

constexpr std::uint64_t front(std::uint64_t word) { return word & kIndexMask; }
constexpr std::uint64_t back(std::uint64_t word) { return word >> kIndexBits & kIndexMask; }
constexpr std::uint64_t epoch_of(std::uint64_t word) { return word >> (2 * kIndexBits); }
constexpr std::uint64_t word_of(std::uint64_t epoch, std::uint64_t chunks) {
  return epoch << (2 * kIndexBits) | chunks << kIndexBits;
}

// A state holds its epoch, so the compare and swap of a late helper fails. Only one of complete()
// and collect() can move a chunk on from kOpen, which decides their race.
enum ChunkState : std::uint64_t { kOpen, kFinished, kDropped };
constexpr std::uint64_t verdict_of(std::uint64_t epoch, ChunkState verdict) {
  return epoch << 2 | verdict;
}

}  // namespace

SplitQueue::SplitQueue(std::size_t capacity)
    : capacity_(capacity), states_(new std::atomic<std::uint64_t>[capacity]) {
  IST_ASSERT(capacity <= kMaxChunks);
}

std::uint64_t SplitQueue::open(std::size_t chunks) noexcept {
  IST_ASSERT(chunks <= capacity_);
  epoch_ = (epoch_ + 1) & kEpochMask;
  for (std::size_t i = 0; i < chunks; ++i)
    states_[i].store(verdict_of(epoch_, kOpen), std::memory_order_relaxed);
  // Release: a helper that claims in this epoch sees the states and all that the caller wrote
  // before. A late helper's claim either falls before this store and is lost with its epoch, or
  // after it and fails.
  word_.store(word_of(epoch_, chunks), std::memory_order_release);
  return epoch_;
}

std::optional<std::size_t> SplitQueue::claim_front() noexcept {
  // Relaxed: the helper passes data to the caller by the states, never by the word. A claim is one
  // read-modify-write, so it carries on the release of open() for later readers.
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (front(word) < back(word)) {
    if (word_.compare_exchange_weak(word, word + kOneFront, std::memory_order_relaxed))
      return front(word);
  }
  return std::nullopt;
}

std::optional<std::size_t> SplitQueue::claim_back(std::uint64_t epoch) noexcept {
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (epoch_of(word) == epoch && front(word) < back(word)) {
    // Acquire: pairs with open().
    if (word_.compare_exchange_weak(word, word - kOneBack, std::memory_order_acquire,
                                    std::memory_order_relaxed))
      return back(word) - 1;
  }
  return std::nullopt;
}

bool SplitQueue::complete(std::uint64_t epoch, std::size_t chunk) noexcept {
  std::uint64_t open = verdict_of(epoch, kOpen);
  // Release: a caller that finds the chunk completed sees the work. A failure carries no data.
  return states_[chunk].compare_exchange_strong(
      open, verdict_of(epoch, kFinished), std::memory_order_release, std::memory_order_relaxed);
}

bool SplitQueue::completed(std::size_t chunk) const noexcept {
  return states_[chunk].load(std::memory_order_acquire) == verdict_of(epoch_, kFinished);
}

std::size_t SplitQueue::close() noexcept {
  // Relaxed, as in claim_front(). The epoch stays: the helper may still complete the chunk that it
  // holds.
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (front(word) < back(word)) {
    if (word_.compare_exchange_weak(word, word + (back(word) - front(word)) * kOneFront,
                                    std::memory_order_relaxed))
      break;
  }
  return back(word);
}

bool SplitQueue::collect(std::size_t chunk, std::chrono::nanoseconds patience) noexcept {
  using Clock = std::chrono::steady_clock;
  if (completed(chunk)) return true;
  for (const Clock::time_point start = Clock::now(); Clock::now() - start < patience;) {
    if (completed(chunk)) return true;
    pause_briefly();
  }
  // Relaxed: dropping a chunk publishes nothing. Where it fails the chunk was completed after all,
  // or dropped before.
  std::uint64_t open = verdict_of(epoch_, kOpen);
  return !states_[chunk].compare_exchange_strong(open, verdict_of(epoch_, kDropped),
                                                 std::memory_order_relaxed) &&
         completed(chunk);
}

}  // namespace ist
