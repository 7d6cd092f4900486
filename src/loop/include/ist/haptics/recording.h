#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <type_traits>

#include "ist/base/api.h"
#include "ist/haptics/simulation.h"

namespace ist {

/// A ContactPoint in plain numbers.
struct ContactRecord {
  std::array<double, 3> position,  ///< on the fixed body, m
      normal,                      ///< of unit length, from the fixed body to the held one
      force;                       ///< on the tool, N
  double gap;                      ///< m
  std::uint32_t fixed_triangle,    ///< by its index in the mesh
      held_triangle,               ///< likewise
      fixed, held;                 ///< the bodies, by their numbers
};

/// A tick as it leaves the servo loop, in plain numbers that may be copied word by word. SI, scene
/// axes.
struct TickRecord {
  /// The translation, then the rotation column by column.
  using Pose = std::array<double, 12>;

  std::uint64_t tick;                   ///< from 0; missing numbers are missed ticks
  double dt;                            ///< nominal length of the tick, s
  Pose device,                          ///< to which the coupling drew the tool
      tool;                             ///< after the tick
  std::array<double, 6> wrench;         ///< on the hand, N and N m about the tool's origin
  bool device_known,                    ///< false: `device` is the last pose that was known
      fault,                            ///< Tick::fault
      held,                             ///< Tick::held
      halved;                           ///< Tick::halved
  std::int32_t steps;                   ///< Tick::steps
  std::optional<QueryResult> contacts,  ///< Tick::contacts, mesh units
      proximity;                        ///< Tick::proximity, mesh units
  double leaf_pairs;                    ///< Tick::leaf_pairs
  std::uint32_t point_count;            ///< of Tick::points
  /// The first `point_count` are Tick::points.
  std::array<ContactRecord, Tick::kMostPoints> points;
  std::optional<HandChange> change;  ///< Tick::change
  std::int64_t begin_ns;             ///< the tick's start, by std::chrono::steady_clock
  std::int64_t late_ns;              ///< from the tick's release to its start
  std::int64_t execution_ns;         ///< to the end of Device::write, or of on_tick()'s work
  std::int64_t cpu_ns;               ///< processor time of the loop's thread meanwhile
};

/// Makes the record of a tick, with times of 0.
[[nodiscard]] IST_API TickRecord record_of(std::uint64_t number, double dt, const Tick& tick,
                                           bool device_known) noexcept;

/// Converts to plain numbers.
[[nodiscard]] IST_API TickRecord::Pose to_numbers(const Placement& placement) noexcept;
/// Converts back. Empty if the numbers are no rigid motion. A rotation that is orthonormal to a few
/// 1e-16 keeps its bits.
[[nodiscard]] IST_API std::optional<Placement> to_placement(
    const TickRecord::Pose& numbers) noexcept;

/// The input of a recorded tick.
struct RecordedTick {
  std::uint64_t tick = 0;                ///< its number, from 0
  std::optional<Placement> device = {};  ///< empty: the device gave no pose
  /// A tick that was held has the steps that it made. A query that a deadline ended has no tests,
  /// but a tick with steps has no limit of contacts. All else has no limit.
  TickBudget budget = {};
};

/// Replays a tick. If all earlier ticks were replayed before, the record equals the recorded one,
/// but for its times, for the tests and the distance of complete queries, and for all numbers of
/// those that a deadline ended.
[[nodiscard]] IST_API TickRecord replay(const RecordedTick& recorded,
                                        Simulation& simulation) noexcept;

namespace detail {
/// Rounds a ring's capacity up to a power of two. Throws kArgumentInvalid outside 1 to 2^32.
[[nodiscard]] IST_API std::size_t ring_capacity(std::size_t asked);
}  // namespace detail

/// A ring buffer from one thread that pushes to one thread that pops, such as from the servo loop
/// to a writer of a file. Neither waits for the other, and no pushed record is lost.
///
/// Each of two counters is written by one side, and only grows: L. Lamport, Proving the correctness
/// of multiprocess programs, IEEE Transactions on Software Engineering 3(2), 1977. Each side caches
/// the other's counter, and reads it again only when the cached value no longer suffices.
template <typename T>
class TickRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Allocates and touches room for `capacity` records, rounded up to a power of two. Throws
  /// kArgumentInvalid for a capacity outside 1 to 2^32; std::bad_alloc.
  explicit TickRing(std::size_t capacity)
      : capacity_(detail::ring_capacity(capacity)), records_(std::make_unique<T[]>(capacity_)) {}

  /// The most records at a time.
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// Pushes a record, in one thread. Returns false if the ring is full. No lock, no system call.
  [[nodiscard]] bool push(const T& record) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_seen_ == capacity_) {
      // Acquire: the popper has read the record that this one overwrites.
      begin_seen_ = begin_.load(std::memory_order_acquire);
      if (end - begin_seen_ == capacity_) return false;
    }
    records_[end & (capacity_ - 1)] = record;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// Pops the oldest records into `out`, in the order of push(), in one thread. Returns their
  /// number. No lock, no system call.
  [[nodiscard]] std::size_t pop(std::span<T> out) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    // Acquire: pairs with the release in push() and makes the records visible.
    if (end_seen_ - begin < out.size()) end_seen_ = end_.load(std::memory_order_acquire);
    const std::size_t count = std::min(end_seen_ - begin, out.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = records_[(begin + i) & (capacity_ - 1)];
    begin_.store(begin + count, std::memory_order_release);
    return count;
  }

  /// Tells the pushing thread that the popping thread will pop no more.
  void close() noexcept { closed_.store(true, std::memory_order_relaxed); }
  /// Whether close() was called, in any thread.
  [[nodiscard]] bool closed() const noexcept { return closed_.load(std::memory_order_relaxed); }

 private:
  std::size_t capacity_;
  std::unique_ptr<T[]> records_;
  // The ring holds the records [begin, end). Each side writes its own cache line.
  alignas(64) std::atomic<std::size_t> end_{0};
  std::size_t begin_seen_ = 0;
  alignas(64) std::atomic<std::size_t> begin_{0};
  std::size_t end_seen_ = 0;
  std::atomic<bool> closed_{false};
};

/// The last value published by one thread, for any number of readers: a sequence lock. The writer
/// never waits; a reader sees one whole value, or tries again.
///
/// The counter is odd while the words are written; a reader compares it before and after its reads.
/// Source: H.-J. Boehm, Can seqlocks get along with programming language memory models?, MSPC 2012,
/// in the form without fences, which ThreadSanitizer does not model: every word is stored with
/// release and loaded with acquire order, so that a reader of a later word also sees the odd
/// counter before it. On x86 these are plain moves.
///
/// T is trivially copyable: arrays of doubles are, Eigen's types are not.
template <typename T>
class Snapshot {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Publishes `first`.
  explicit Snapshot(const T& first = T()) noexcept { publish(first); }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  /// Publishes a value, in one thread. No lock, no system call; one store a word.
  void publish(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_relaxed);  // visible with any word stored below
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    count_.store(count + 2, std::memory_order_release);
  }

  /// Reads the last value, in any thread. Empty if the writer interfered. No lock, no system call;
  /// one load a word.
  [[nodiscard]] std::optional<T> try_read() const noexcept {
    const std::uint64_t count = count_.load(std::memory_order_acquire);
    if (count % 2 != 0) return std::nullopt;
    std::array<std::uint64_t, kWords> words;
    for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if (count_.load(std::memory_order_relaxed) != count) return std::nullopt;
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), words.data(), sizeof(T));
    return __builtin_bit_cast(T, bytes);  // std::bit_cast: not in libc++ 14
  }

  /// Reads the last value, and yields the core between attempts. Not for a tick, nor for a thread
  /// of higher priority on the writer's core.
  [[nodiscard]] T read() const noexcept {
    for (;;) {
      if (const std::optional<T> value = try_read()) return *value;
      std::this_thread::yield();
    }
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  alignas(64) std::atomic<std::uint64_t> count_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace ist
