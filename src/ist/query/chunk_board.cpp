#include "ist/query/chunk_board.h"

#include <xmmintrin.h>

#include "ist/base/assert.h"

namespace ist {
namespace {

// The word: the free chunks are [front, back). 38 bits of epoch go round after a year and a half of
// 5000 epochs a second, and only a helper that slept all that time could be deceived.
constexpr int kIndexBits = 13;
constexpr std::uint64_t kIndexMask = (1u << kIndexBits) - 1;
static_assert(ChunkBoard::kMaxChunks <= kIndexMask);
constexpr std::uint64_t kOneFront = 1, kOneBack = std::uint64_t{1} << kIndexBits;
constexpr std::uint64_t kEpochMask = ~std::uint64_t{0} >> (2 * kIndexBits);

constexpr std::uint64_t front(std::uint64_t word) { return word & kIndexMask; }
constexpr std::uint64_t back(std::uint64_t word) { return word >> kIndexBits & kIndexMask; }
constexpr std::uint64_t epoch_of(std::uint64_t word) { return word >> (2 * kIndexBits); }
constexpr std::uint64_t word_of(std::uint64_t epoch, std::uint64_t chunks) {
  return epoch << (2 * kIndexBits) | chunks << kIndexBits;
}

// A verdict names its epoch, so that a late helper's compare and swap finds another one and fails.
// Only one of finish() and take() can move a chunk on from kOpen: that is what settles their race.
enum Verdict : std::uint64_t { kOpen, kFinished, kDropped };
constexpr std::uint64_t verdict_of(std::uint64_t epoch, Verdict verdict) {
  return epoch << 2 | verdict;
}

}  // namespace

ChunkBoard::ChunkBoard(std::size_t capacity)
    : capacity_(capacity), verdicts_(new std::atomic<std::uint64_t>[capacity]) {
  IST_ASSERT(capacity <= kMaxChunks);
}

std::uint64_t ChunkBoard::open(std::size_t chunks) noexcept {
  IST_ASSERT(chunks <= capacity_);
  epoch_ = (epoch_ + 1) & kEpochMask;
  for (std::size_t i = 0; i < chunks; ++i)
    verdicts_[i].store(verdict_of(epoch_, kOpen), std::memory_order_relaxed);
  // Release: whoever claims in this epoch sees the verdicts and what the caller wrote before. A
  // late helper's claim falls before this store and is lost with its epoch, or after and fails.
  word_.store(word_of(epoch_, chunks), std::memory_order_release);
  return epoch_;
}

std::optional<std::size_t> ChunkBoard::claim_front() noexcept {
  // Relaxed: the caller gets nothing from the helper by the word, only by verdicts. And a claim,
  // being a read and a write in one, leaves the release of open() to those who read it after.
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (front(word) < back(word)) {
    if (word_.compare_exchange_weak(word, word + kOneFront, std::memory_order_relaxed))
      return front(word);
  }
  return std::nullopt;
}

std::optional<std::size_t> ChunkBoard::claim_back(std::uint64_t epoch) noexcept {
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (epoch_of(word) == epoch && front(word) < back(word)) {
    // Acquire: pairs with open().
    if (word_.compare_exchange_weak(word, word - kOneBack, std::memory_order_acquire,
                                    std::memory_order_relaxed))
      return back(word) - 1;
  }
  return std::nullopt;
}

bool ChunkBoard::finish(std::uint64_t epoch, std::size_t chunk) noexcept {
  std::uint64_t open = verdict_of(epoch, kOpen);
  // Release: the caller that finds it finished sees the work. Failing tells the helper nothing but
  // that.
  return verdicts_[chunk].compare_exchange_strong(
      open, verdict_of(epoch, kFinished), std::memory_order_release, std::memory_order_relaxed);
}

bool ChunkBoard::finished(std::size_t chunk) const noexcept {
  return verdicts_[chunk].load(std::memory_order_acquire) == verdict_of(epoch_, kFinished);
}

std::size_t ChunkBoard::close() noexcept {
  // Relaxed, as in claim_front(). The epoch stays: a chunk in the helper's hands may be finished.
  std::uint64_t word = word_.load(std::memory_order_relaxed);
  while (front(word) < back(word)) {
    if (word_.compare_exchange_weak(word, word + (back(word) - front(word)) * kOneFront,
                                    std::memory_order_relaxed))
      break;
  }
  return back(word);
}

bool ChunkBoard::take(std::size_t chunk, std::chrono::nanoseconds patience) noexcept {
  using Clock = std::chrono::steady_clock;
  if (finished(chunk)) return true;
  for (const Clock::time_point start = Clock::now(); Clock::now() - start < patience;) {
    if (finished(chunk)) return true;
    _mm_pause();
  }
  // Relaxed: dropping hands nothing over. Where it fails the chunk was finished after all, or
  // dropped before.
  std::uint64_t open = verdict_of(epoch_, kOpen);
  return !verdicts_[chunk].compare_exchange_strong(open, verdict_of(epoch_, kDropped),
                                                   std::memory_order_relaxed) &&
         finished(chunk);
}

}  // namespace ist
