#pragma once

#include <gmp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ist {

/// A whole number of at most N limbs, on the stack, over GMP's lowest layer, which allocates
/// nothing: enough to find the sign of a small determinant.
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
    std::fill_n(limb_, whole, mp_limb_t{0});
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
    const auto a = static_cast<mp_size_t>(size_), b = static_cast<mp_size_t>(other.size_);
    const mp_limb_t top = a >= b ? mpn_mul(product.limb_, limb_, a, other.limb_, b)
                                 : mpn_mul(product.limb_, other.limb_, b, limb_, a);
    product.size_ = size_ + other.size_ - (top == 0 ? 1 : 0);
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
  static constexpr unsigned kBits = 64;
  static_assert(GMP_NUMB_BITS == kBits);

  template <std::size_t M>
  [[nodiscard]] auto sum(const WholeNumber<M>& other, bool other_negative) const noexcept {
    WholeNumber<std::max(N, M) + 1> sum;
    const mp_limb_t *a = limb_, *b = other.limb_;  // the larger and the smaller by absolute value
    auto of_a = static_cast<mp_size_t>(size_), of_b = static_cast<mp_size_t>(other.size_);
    sum.negative_ = negative_;
    if (of_a < of_b || (of_a == of_b && of_a > 0 && mpn_cmp(a, b, of_a) < 0)) {
      std::swap(a, b);
      std::swap(of_a, of_b);
      sum.negative_ = other_negative;
    }
    sum.size_ = static_cast<std::size_t>(of_a);
    if (of_b == 0) {
      std::copy_n(a, of_a, sum.limb_);
    } else if (negative_ == other_negative) {
      const mp_limb_t carry = mpn_add(sum.limb_, a, of_a, b, of_b);
      if (carry != 0) sum.limb_[sum.size_++] = carry;
    } else {
      mpn_sub(sum.limb_, a, of_a, b, of_b);
      while (sum.size_ > 0 && sum.limb_[sum.size_ - 1] == 0) --sum.size_;
    }
    return sum;
  }

  std::size_t size_ = 0;  // without leading zeros
  bool negative_ = false;
  mp_limb_t limb_[N];  // least first; undefined from size_ on
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
