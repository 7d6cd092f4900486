#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace ist {

/// A two-ended work-stealing range: divides a list of chunks between a caller, who works from the
/// front, and one helper, who works from the back. Each chunk is done by one of them, and the
/// caller never depends on the helper:
///
///     caller                                     helper
///     epoch = open(n)                            while (i = claim_back(epoch))
///     while (i = claim_front()) do chunk i         do chunk i
///     for (i = close(); i < n; ++i)                complete(epoch, i)
///       if (!collect(i, patience)) do chunk i
///
/// The helper's chunks are the last ones, so the caller meets all of them in order. The chunk of a
/// stalled helper is dropped; a helper that comes late, in an epoch that is over, claims nothing
/// and completes nothing.
///
/// Every call is noexcept, locks nothing, allocates nothing and makes no system call (the clock is
/// read through the vDSO). Cost: a claim is one compare and swap, 5 to 100 ns by where its cache
/// line is; each side repeats it only when the other claimed in between.
class SplitQueue {
 public:
  static constexpr std::size_t kMaxChunks = 4096;

  /// Reserves memory for lists of up to `capacity` chunks, at most kMaxChunks; 8 bytes a chunk.
  explicit SplitQueue(std::size_t capacity);

  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// Caller: begins an epoch with chunks 0 … `chunks` - 1, all free, and returns its number. A
  /// helper that claims one of them sees everything the caller wrote before. Cost: 0.3 ns a chunk.
  std::uint64_t open(std::size_t chunks) noexcept;

  /// Caller: claims the first free chunk; returns nothing when all are claimed.
  [[nodiscard]] std::optional<std::size_t> claim_front() noexcept;

  /// Helper: claims the last free chunk of `epoch`; returns nothing when all are claimed or the
  /// epoch is over.
  [[nodiscard]] std::optional<std::size_t> claim_back(std::uint64_t epoch) noexcept;

  /// Helper: reports chunk `chunk`, which it claimed in `epoch`, as done. Returns false when the
  /// caller dropped it or the epoch is over: then the work is discarded.
  bool complete(std::uint64_t epoch, std::size_t chunk) noexcept;

  /// Caller: returns whether the helper completed this chunk of the open epoch. If so, everything
  /// the helper wrote before complete() is visible.
  [[nodiscard]] bool completed(std::size_t chunk) const noexcept;

  /// Caller: ends claiming, and returns the first chunk that the helper claimed; all after it are
  /// the helper's too. Free chunks before it belong to nobody.
  std::size_t close() noexcept;

  /// Caller: waits up to `patience` for a chunk that the helper claimed, and then drops it. Returns
  /// true if the helper completed it, false if the caller must do it again. The helper claims a
  /// chunk only after it completed the one before, so at most one chunk an epoch is waited for.
  [[nodiscard]] bool collect(std::size_t chunk, std::chrono::nanoseconds patience) noexcept;

 private:
  std::size_t capacity_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> states_;  // epoch and ChunkState of each chunk
  std::uint64_t epoch_ = 0;                               // the caller's copy
  alignas(64) std::atomic<std::uint64_t> word_{0};        // epoch, back, front
};

}  // namespace ist
