#pragma once

#include <array>
#include <cstdint>

namespace ist {

/// The random numbers of one pose: those of numpy's
/// `Generator(Philox(key=seed, counter=[0, stream, 0, 0]))`, word by word.
///
/// Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011:
/// Philox4x64-10, whose block depends on its counter alone.
class Philox {
 public:
  Philox(std::uint64_t seed, std::uint64_t stream) noexcept : seed_(seed), stream_(stream) {}

  /// Returns the next 64 random bits.
  std::uint64_t bits() noexcept {
    if (used_ == block_.size()) {
      ++blocks_;  // numpy counts before it makes a block, so the first has number 1
      block_ = block(blocks_);
      used_ = 0;
    }
    return block_[used_++];
  }

  /// Returns a number from [0, 1), a multiple of 2⁻⁵³.
  double uniform() noexcept { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  using Block = std::array<std::uint64_t, 4>;

  [[nodiscard]] Block block(std::uint64_t number) const noexcept {
    constexpr std::uint64_t kMultiplier0 = 0xD2E7470EE14C6C93, kMultiplier1 = 0xCA5A826395121157;
    constexpr std::uint64_t kStep0 = 0x9E3779B97F4A7C15, kStep1 = 0xBB67AE8584CAA73B;
    constexpr int kRounds = 10;
    Block x{number, stream_, 0, 0};
    std::uint64_t key0 = seed_, key1 = 0;
    for (int round = 0; round < kRounds; ++round) {
      const Wide a = multiply(kMultiplier0, x[0]), b = multiply(kMultiplier1, x[2]);
      x = {b.high ^ x[1] ^ key0, b.low, a.high ^ x[3] ^ key1, a.low};
      key0 += kStep0;
      key1 += kStep1;
    }
    return x;
  }

  struct Wide {
    std::uint64_t high, low;
  };
  static Wide multiply(std::uint64_t a, std::uint64_t b) noexcept {
    __extension__ using Product = unsigned __int128;
    const Product product = static_cast<Product>(a) * b;
    return {static_cast<std::uint64_t>(product >> 64), static_cast<std::uint64_t>(product)};
  }

  std::uint64_t seed_, stream_;
  Block block_{};
  std::size_t used_ = 4;
  std::uint64_t blocks_ = 0;
};

}  // namespace ist
