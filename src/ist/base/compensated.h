#pragma once

namespace ist {

/// Accumulates a sum or dot product in twice the precision of double and rounds it once at the end:
/// |error| <= u·|result| + n²u²·Σ|terms|, u = 2⁻⁵³. Uses + - × only, so every instruction set gives
/// the same bits.
///
/// Source: T. Ogita, S. M. Rump, S. Oishi, Accurate sum and dot product, SIAM J. Sci. Comput.
/// 26(6), 2005 (algorithms Sum2 and Dot2); Dekker's product, without a fused multiply-add.
class CompensatedSum {
 public:
  void add(double term) noexcept {
    const double sum = sum_ + term;
    const double of_term = sum - sum_;
    error_ += (sum_ - (sum - of_term)) + (term - of_term);
    sum_ = sum;
  }

  void add_product(double a, double b) noexcept {
    const double product = a * b;
    const Halves ah = split(a), bh = split(b);
    error_ +=
        ah.low * bh.low - (((product - ah.high * bh.high) - ah.low * bh.high) - ah.high * bh.low);
    add(product);
  }

  [[nodiscard]] double value() const noexcept { return sum_ + error_; }

 private:
  struct Halves {
    double high, low;
  };
  // Veltkamp's split: two halves of at most 26 bits, whose products are exact.
  static Halves split(double a) noexcept {
    const double scaled = 134217729.0 * a;  // 2²⁷ + 1
    const double high = scaled - (scaled - a);
    return {high, a - high};
  }

  double sum_ = 0, error_ = 0;
};

}  // namespace ist
