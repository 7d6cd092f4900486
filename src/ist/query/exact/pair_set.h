#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ist {

/// A hash set of pairs, of bounded size, cleared in time proportional to its content. Pairs with
/// the same first number and near second numbers lie close together in memory.
class PairSet {
 public:
  /// @param most pairs that fit; 20 to 36 bytes are reserved for each
  explicit PairSet(std::size_t most);

  enum class Insertion : std::uint8_t { kNew, kKnown, kFull };
  /// Inserts a pair. Precondition: not both numbers are 2^32 - 1.
  Insertion insert(std::uint32_t first, std::uint32_t second) noexcept {
    const std::uint64_t key = std::uint64_t{first} << 32 | second;
    std::size_t slot = (hash(key >> kNearBits) >> shift_) + (key & kNear);
    for (;; ++slot) {
      slot &= slots_.size() - 1;
      if (slots_[slot] == key) return Insertion::kKnown;
      if (slots_[slot] == kNone) break;
    }
    if (used_count_ == used_.size()) return Insertion::kFull;
    slots_[slot] = key;
    used_[used_count_++] = static_cast<std::uint32_t>(slot);
    return Insertion::kNew;
  }
  void clear() noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return slots_.size() * sizeof(std::uint64_t) + used_.size() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  // Runs of 2^kNearBits second numbers lie in four cache lines, and the runs far from each other.
  static constexpr int kNearBits = 5;
  static constexpr std::uint64_t kNear = (1 << kNearBits) - 1;
  [[nodiscard]] static std::uint64_t hash(std::uint64_t number) noexcept {
    return number * 0x9E3779B97F4A7C15;
  }

  std::vector<std::uint64_t> slots_;  // at least twice as many as keys
  std::vector<std::uint32_t> used_;
  std::size_t used_count_ = 0;
  int shift_;
};

}  // namespace ist
