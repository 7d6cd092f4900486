#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ist {

/// A whole number of at most N limbs of 64 bits, on the stack: enough to find the sign of a small
/// determinant.
template <std::size_t N>
class WholeNumber {
 public:
  WholeNumber() = default;

  /// Makes value · 2^-exponent. Precondition: it is whole and fits.
  WholeNumber(double value, int exponent) noexcept {
    int shift = 0;
    auto digits = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(value), &shift), 53));
    if (digits == 0) return;
    shift -= 53 + exponent;
    if (shift < 0) {
      digits >>= -shift;
      shift = 0;
    }
    const auto whole = static_cast<std::size_t>(shift) / kBits;
    const unsigned rest = static_cast<unsigned>(shift) % kBits;
    std::fill_n(limb_, whole, Limb{0});
    limb_[whole] = digits << rest;
    size_ = whole + 1;
    if (rest > 0 && (digits >> (kBits - rest)) != 0) limb_[size_++] = digits >> (kBits - rest);
    negative_ = value < 0;
  }

  [[nodiscard]] int sign() const noexcept { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

  template <std::size_t M>
  [[nodiscard]] auto operator*(const WholeNumber<M>& other) const noexcept {
    WholeNumber<N + M> product;
    if (size_ == 0 || other.size_ == 0) return product;
    std::fill_n(product.limb_, size_ + other.size_, Limb{0});
    for (std::size_t i = 0; i < size_; ++i) {
      Limb carry = 0;
      for (std::size_t j = 0; j < other.size_; ++j) {
        const Wide sum = Wide{limb_[i]} * other.limb_[j] + product.limb_[i + j] + carry;
        product.limb_[i + j] = static_cast<Limb>(sum);
        carry = static_cast<Limb>(sum >> kBits);
      }
      product.limb_[i + other.size_] = carry;
    }
    product.size_ = size_ + other.size_;
    product.drop_zeros();
    product.negative_ = negative_ != other.negative_;
    return product;
  }

  template <std::size_t M>
  [[nodiscard]] auto operator-(const WholeNumber<M>& other) const noexcept {
    return sum(other, !other.negative_);
  }
  template <std::size_t M>
  [[nodiscard]] auto operator+(const WholeNumber<M>& other) const noexcept {
    return sum(other, other.negative_);
  }

 private:
  template <std::size_t>
  friend class WholeNumber;
  using Limb = std::uint64_t;
  __extension__ using Wide = unsigned __int128;
  static constexpr unsigned kBits = 64;

  template <std::size_t M>
  [[nodiscard]] auto sum(const WholeNumber<M>& other, bool other_negative) const noexcept {
    WholeNumber<std::max(N, M) + 1> sum;
    const Limb *a = limb_, *b = other.limb_;  // the larger and the smaller by absolute value
    std::size_t of_a = size_, of_b = other.size_;
    sum.negative_ = negative_;
    if (is_less(a, of_a, b, of_b)) {
      std::swap(a, b);
      std::swap(of_a, of_b);
      sum.negative_ = other_negative;
    }
    const bool add = negative_ == other_negative;
    Limb carry = 0;
    for (std::size_t i = 0; i < of_a; ++i) {
      const Wide low = i < of_b ? b[i] : 0;
      const Wide digits = add ? a[i] + low + carry : a[i] - low - carry;
      sum.limb_[i] = static_cast<Limb>(digits);
      carry = static_cast<Limb>(digits >> kBits) & 1;
    }
    sum.size_ = of_a;
    if (carry != 0) sum.limb_[sum.size_++] = carry;
    sum.drop_zeros();
    return sum;
  }

  [[nodiscard]] static bool is_less(const Limb* a, std::size_t of_a, const Limb* b,
                                    std::size_t of_b) noexcept {
    if (of_a != of_b) return of_a < of_b;
    while (of_a > 0 && a[of_a - 1] == b[of_a - 1]) --of_a;
    return of_a > 0 && a[of_a - 1] < b[of_a - 1];
  }

  void drop_zeros() noexcept {
    while (size_ > 0 && limb_[size_ - 1] == 0) --size_;
  }

  std::size_t size_ = 0;  // without leading zeros
  bool negative_ = false;
  Limb limb_[N];  // least first; undefined from size_ on
};

/// Returns the exponent of a double's last nonzero digit: value · 2^-exponent is whole and odd. For
/// 0 it is greater than for any other.
[[nodiscard]] inline int last_digit(double value) noexcept {
  if (value == 0) return 2000;
  int exponent = 0;
  const auto digits =
      static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), 53));
  return exponent - 53 + std::countr_zero(digits);
}

}  // namespace ist
