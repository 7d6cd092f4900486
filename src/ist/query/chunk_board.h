#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace ist {

/// Divides a list of chunks between a caller, who works from the front, and one helper, who works
/// from the back, so that each chunk is done by one of them and the caller never depends on the
/// helper:
///
///     caller                                     helper
///     epoch = open(n)                            while (i = claim_back(epoch))
///     while (i = claim_front()) do chunk i         do chunk i
///     for (i = close(); i < n; ++i)                finish(epoch, i)
///       if (!take(i, patience)) do chunk i
///
/// The helper's chunks are the last ones, so the caller still meets all of them in order. A helper
/// that is stalled in its chunk has it dropped, and one that comes late, in an epoch that is over,
/// claims nothing and finishes nothing.
///
/// Every call is noexcept, locks nothing, allocates nothing and makes no system call (the clock is
/// read through the vDSO). Cost: a claim is one compare and swap, 5 to 100 ns by where its cache
/// line is; each side repeats it only when the other claimed in between.
class ChunkBoard {
 public:
  static constexpr std::size_t kMaxChunks = 4096;

  /// Room for lists of up to `capacity` chunks, at most kMaxChunks. 8 bytes a chunk.
  explicit ChunkBoard(std::size_t capacity);

  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// Caller: begins an epoch with chunks 0 … `chunks` - 1, all free, and names it. What the caller
  /// wrote before is seen by a helper that claims a chunk of it. Cost: 0.3 ns a chunk.
  std::uint64_t open(std::size_t chunks) noexcept;

  /// Caller: the first free chunk, or none when all are claimed.
  [[nodiscard]] std::optional<std::size_t> claim_front() noexcept;

  /// Helper: the last free chunk of `epoch`, or none when all are claimed or the epoch is over.
  [[nodiscard]] std::optional<std::size_t> claim_back(std::uint64_t epoch) noexcept;

  /// Helper: chunk `chunk`, which it claimed in `epoch`, is done. False when the caller dropped it
  /// or the epoch is over: what the helper made of it then counts for nothing.
  bool finish(std::uint64_t epoch, std::size_t chunk) noexcept;

  /// Caller: whether the helper finished this chunk of the open epoch. If so, what the helper wrote
  /// before finish() is seen.
  [[nodiscard]] bool finished(std::size_t chunk) const noexcept;

  /// Caller: ends claiming. All chunks from the returned one on were claimed by the helper; those
  /// before it that the caller did not claim are nobody's.
  std::size_t close() noexcept;

  /// Caller: settles a chunk that the helper claimed. Waits up to `patience` for it to be finished,
  /// and then drops it. True: it is the helper's, and finished as finished() says. False: it is
  /// the caller's to do again. As the helper claims a chunk only after it finished the one before,
  /// at most one chunk an epoch is waited for.
  [[nodiscard]] bool take(std::size_t chunk, std::chrono::nanoseconds patience) noexcept;

 private:
  std::size_t capacity_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> verdicts_;  // a chunk's epoch and where it stands
  std::uint64_t epoch_ = 0;                                 // the caller's copy
  alignas(64) std::atomic<std::uint64_t> word_{0};          // epoch, back, front
};

}  // namespace ist
