#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "simd/step.h"

namespace ist::test {

/// Memory for `size` values that begins `offset` values behind a multiple of 64 bytes, with guard
/// bytes before and behind it.
template <class T>
class Guarded {
 public:
  Guarded(std::size_t size, std::size_t offset)
      : size_(size), bytes_((size + offset) * sizeof(T) + 2 * kGuards + 64, kGuard) {
    void* aligned = bytes_.data() + kGuards;
    std::size_t room = bytes_.size();
    std::align(64, 1, aligned, room);
    data_ = static_cast<T*>(aligned) + offset;
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] std::span<T> span() { return {data_, size_}; }
  /// Whether nothing was written but the values.
  [[nodiscard]] bool intact() const { return untouched_from(size_); }
  /// Whether nothing was written but the first `count` values.
  [[nodiscard]] bool untouched_from(std::size_t count) const {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(data_);
    const auto untouched = [](std::uint8_t byte) { return byte == kGuard; };
    return std::all_of(bytes_.data(), begin, untouched) &&
           std::all_of(begin + count * sizeof(T), bytes_.data() + bytes_.size(), untouched);
  }

 private:
  static constexpr std::size_t kGuards = 256;
  static constexpr std::uint8_t kGuard = 0xA5;
  std::size_t size_;
  std::vector<std::uint8_t> bytes_;
  T* data_;
};

/// A frontier in guarded memory.
class GuardedFrontier : public Frontier {
 public:
  GuardedFrontier(std::size_t room, std::size_t offset)
      : Frontier{}, groups_(room + kFrontierSpare, offset), moving_(room + kFrontierSpare, offset) {
    groups = groups_.data();
    moving = moving_.data();
    capacity = room;
  }
  void append(std::uint32_t fixed, std::span<const std::uint32_t> with) {
    std::copy(with.begin(), with.end(), moving + moving_count);
    moving_count += with.size();
    groups[group_count++] = {fixed, static_cast<std::uint32_t>(moving_count)};
  }
  void clear() { group_count = moving_count = 0; }
  [[nodiscard]] bool intact() const { return groups_.intact() && moving_.intact(); }

 private:
  Guarded<SearchGroup> groups_;
  Guarded<std::uint32_t> moving_;
};

/// Whether both hold the same pairs, in the same groups.
[[nodiscard]] inline bool same_pairs(const Frontier& a, const Frontier& b) {
  return a.group_count == b.group_count && a.moving_count == b.moving_count &&
         std::memcmp(a.groups, b.groups, a.group_count * sizeof(SearchGroup)) == 0 &&
         std::memcmp(a.moving, b.moving, a.moving_count * sizeof(std::uint32_t)) == 0;
}

}  // namespace ist::test
