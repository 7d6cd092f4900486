#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <thread>
#include <type_traits>

namespace ist {

/// The last value that one thread published, for any number of threads to read: a sequence lock.
/// The writer never waits, however many read; a reader sees one whole value, or tries again.
///
/// A reader looks at a counter before and after the words of the value; the writer makes it odd
/// before it touches them and even after. Source: H.-J. Boehm, Can seqlocks get along with
/// programming language memory models?, MSPC 2012, in the form without fences, of which
/// ThreadSanitizer knows nothing: every word is stored with release and loaded with acquire order.
/// A reader that meets a word of a later value then also meets the odd counter that went before,
/// and drops what it read. On x86 these are plain moves, and no fence would be less.
///
/// T is trivially copyable, which types of Eigen are not: arrays of doubles are.
template <typename T>
class Snapshot {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit Snapshot(const T& first = T()) noexcept { publish(first); }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  /// For one thread. No lock, no system call; one store a word.
  void publish(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_relaxed);  // seen by who sees a word stored below
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    count_.store(count + 2, std::memory_order_release);
  }

  /// The value that was published last; nothing where the writer came in between. For any thread.
  /// No lock, no system call; one load a word.
  [[nodiscard]] std::optional<T> try_read() const noexcept {
    const std::uint64_t count = count_.load(std::memory_order_acquire);
    if (count % 2 != 0) return std::nullopt;
    std::array<std::uint64_t, kWords> words;
    for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if (count_.load(std::memory_order_relaxed) != count) return std::nullopt;
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), words.data(), sizeof(T));
    return std::bit_cast<T>(bytes);
  }

  /// Tries until it reads one, and yields the core in between, as the writer may be waiting for it.
  /// Not for a tick, nor for a thread that takes the writer's core by a higher priority.
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
