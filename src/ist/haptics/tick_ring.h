#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace ist {

/// Records on their way from the loop to a thread that writes them down: a ring of fixed size for
/// one thread that pushes and one that pops. Neither waits for the other, and nothing is lost that
/// push() took.
///
/// Two counters that only grow, each written by one side, as in L. Lamport, Proving the correctness
/// of multiprocess programs, IEEE Transactions on Software Engineering 3(2), 1977. Each side keeps
/// what it last saw of the other's, and looks again only when that no longer suffices.
template <typename T>
class TickRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Room for `capacity` records, rounded up to a power of two. All memory is allocated and touched
  /// here. Throws std::bad_alloc.
  explicit TickRing(std::size_t capacity)
      : capacity_(std::bit_ceil(capacity)), records_(std::make_unique<T[]>(capacity_)) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// For one thread: the record goes behind all others. False where there is no room: it is then
  /// the caller's to count what was lost. No lock, no system call.
  [[nodiscard]] bool push(const T& record) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_seen_ == capacity_) {
      // Acquire: the popper has read the record whose place this one takes.
      begin_seen_ = begin_.load(std::memory_order_acquire);
      if (end - begin_seen_ == capacity_) return false;
    }
    records_[end & (capacity_ - 1)] = record;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// For one thread: takes the oldest records, in the order in which they were pushed, as many as
  /// there are and `out` has room for. Returns how many. No lock, no system call.
  [[nodiscard]] std::size_t pop(std::span<T> out) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    // Acquire: pairs with push(), and brings what is in the records.
    if (end_seen_ - begin < out.size()) end_seen_ = end_.load(std::memory_order_acquire);
    const std::size_t count = std::min(end_seen_ - begin, out.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = records_[(begin + i) & (capacity_ - 1)];
    begin_.store(begin + count, std::memory_order_release);
    return count;
  }

  /// By the one who pops, who pops no more: what is pushed now is lost.
  void close() noexcept { closed_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool closed() const noexcept { return closed_.load(std::memory_order_relaxed); }

 private:
  std::size_t capacity_;
  std::unique_ptr<T[]> records_;
  // What is in the ring are records [begin, end). A line each for what either side writes.
  alignas(64) std::atomic<std::size_t> end_{0};
  std::size_t begin_seen_ = 0;
  alignas(64) std::atomic<std::size_t> begin_{0};
  std::size_t end_seen_ = 0;
  std::atomic<bool> closed_{false};
};

}  // namespace ist
