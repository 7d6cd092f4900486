#include "ist/mesh/orientation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ist {
namespace {

// A whole number of at most N limbs of 64 bits, on the stack: enough to find the sign of a small
// determinant.
template <std::size_t N>
class WholeNumber {
 public:
  WholeNumber() = default;

  // Makes value · 2^-exponent. Precondition: it is whole and fits.
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

// Returns the exponent of a double's last nonzero digit: value · 2^-exponent is whole and odd. For
// 0 it is greater than for any other.
int last_digit(double value) noexcept {
  if (value == 0) return 2000;
  int exponent = 0;
  const auto digits =
      static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), 53));
  return exponent - 53 + std::countr_zero(digits);
}

constexpr double kRounding = 0x1p-53;
// Shewchuk's bounds are (7 + 56ε)ε and (3 + 16ε)ε of the sum of the products' absolute values.
// Where that sum is above kSmall, underflow loses less than is added here.
constexpr double kBound3 = 8 * kRounding, kBound2 = 4 * kRounding, kSmall = 0x1p-600;

int sign_of(double x) { return x > 0 ? 1 : -1; }

// The digits of all finite doubles span 2098 bits: 33 limbs.
constexpr std::size_t kLimbs = 33;
using Coordinate = WholeNumber<kLimbs>;

template <int kDimension, std::size_t kPoints>
using Points = const Eigen::Matrix<double, kDimension, 1>* const (&)[kPoints];

template <int kDimension, std::size_t kPoints>
int last_digit_of(Points<kDimension, kPoints> points) {
  int last = 2000;
  for (const auto* point : points) {
    for (Eigen::Index i = 0; i < kDimension; ++i) last = std::min(last, last_digit((*point)[i]));
  }
  return last;
}

__extension__ using Int128 = __int128;

// Coordinates as whole numbers of at most `bits` bits, in one unit.
template <int kDimension, std::size_t kPoints>
struct SmallPoints {
  SmallPoints(Points<kDimension, kPoints> points, int bits) noexcept {
    double largest = 0;
    for (const auto* point : points) {
      for (Eigen::Index i = 0; i < kDimension; ++i) {
        largest = std::max(largest, std::abs((*point)[i]));
      }
    }
    if (!(largest < 0x1p600 && largest > 0x1p-600)) return;
    int exponent = 0;
    static_cast<void>(std::frexp(largest, &exponent));
    const double scale = std::ldexp(1.0, bits - exponent);
    for (std::size_t k = 0; k < kPoints; ++k) {
      for (std::size_t i = 0; i < kDimension; ++i) {
        const double coordinate = (*points[k])[static_cast<Eigen::Index>(i)];
        const double scaled = coordinate * scale;
        at[k][i] = static_cast<std::int64_t>(scaled);
        if (static_cast<double>(at[k][i]) != scaled || (at[k][i] == 0) != (coordinate == 0)) return;
      }
    }
    fit = true;
  }

  std::array<std::array<std::int64_t, std::size_t{kDimension}>, kPoints> at;
  bool fit = false;  // else `at` is undefined
};

int sign_of(Int128 x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

int exact_orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& d) noexcept {
  const Eigen::Vector3d* const points[] = {&a, &b, &c, &d};
  if (const SmallPoints<3, 4> small(points, 40); small.fit) {  // the sum is below 2^126
    const auto from_d = [&](std::size_t k, std::size_t i) {
      return Int128{small.at[k][i] - small.at[3][i]};
    };
    const auto minor = [&](std::size_t k, std::size_t l) {
      return from_d(k, 0) * from_d(l, 1) - from_d(l, 0) * from_d(k, 1);
    };
    return sign_of(from_d(0, 2) * minor(1, 2) + from_d(1, 2) * minor(2, 0) +
                   from_d(2, 2) * minor(0, 1));
  }
  const int last = last_digit_of<3>(points);
  const auto from_d = [&](const Eigen::Vector3d& p, Eigen::Index axis) {
    return Coordinate(p[axis], last) - Coordinate(d[axis], last);
  };
  const auto ax = from_d(a, 0), ay = from_d(a, 1), az = from_d(a, 2);
  const auto bx = from_d(b, 0), by = from_d(b, 1), bz = from_d(b, 2);
  const auto cx = from_d(c, 0), cy = from_d(c, 1), cz = from_d(c, 2);
  const auto of_a = az * (bx * cy - cx * by), of_b = bz * (cx * ay - ax * cy),
             of_c = cz * (ax * by - bx * ay);
  return (of_a + of_b + of_c).sign();
}

int exact_orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                      const Eigen::Vector2d& c) noexcept {
  const Eigen::Vector2d* const points[] = {&a, &b, &c};
  if (const SmallPoints<2, 3> small(points, 61); small.fit) {
    const auto from_c = [&](std::size_t k, std::size_t i) {
      return Int128{small.at[k][i] - small.at[2][i]};
    };
    return sign_of(from_c(0, 0) * from_c(1, 1) - from_c(0, 1) * from_c(1, 0));
  }
  const int last = last_digit_of<2>(points);
  const auto from_c = [&](const Eigen::Vector2d& p, Eigen::Index axis) {
    return Coordinate(p[axis], last) - Coordinate(c[axis], last);
  };
  return (from_c(a, 0) * from_c(b, 1) - from_c(a, 1) * from_c(b, 0)).sign();
}

}  // namespace

int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) noexcept {
  const double ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
  const double bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
  const double cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
  const double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
  const double determinant = (az * (bc - cb) + bz * (ca - ac)) + cz * (ab - ba);
  const double sizes = ((std::abs(bc) + std::abs(cb)) * std::abs(az) +
                        (std::abs(ca) + std::abs(ac)) * std::abs(bz)) +
                       (std::abs(ab) + std::abs(ba)) * std::abs(cz);
  if (std::abs(determinant) > kBound3 * sizes && sizes > kSmall) return sign_of(determinant);
  return exact_orientation(a, b, c, d);
}

// Evaluates the same determinant by its last row, -(d - a) · ((b - a) × (c - a)), so that the
// products of the first two are computed once. Shewchuk's bound holds for it too: it has the same
// form.
OrientedPlane::OrientedPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c) noexcept
    : a_(a), b_(b), c_(c) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index j = (i + 1) % 3, k = (i + 2) % 3;
    const double left = (b[j] - a[j]) * (c[k] - a[k]), right = (b[k] - a[k]) * (c[j] - a[j]);
    normal_[i] = left - right;
    sizes_[i] = std::abs(left) + std::abs(right);
  }
}

int OrientedPlane::side_of(const Eigen::Vector3d& d) const noexcept {
  const double x = a_[0] - d[0], y = a_[1] - d[1], z = a_[2] - d[2];
  const double determinant = (x * normal_[0] + y * normal_[1]) + z * normal_[2];
  const double sizes =
      (std::abs(x) * sizes_[0] + std::abs(y) * sizes_[1]) + std::abs(z) * sizes_[2];
  if (std::abs(determinant) > kBound3 * sizes && sizes > kSmall) return sign_of(determinant);
  return exact_orientation(a_, b_, c_, d);
}

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                const Eigen::Vector2d& c) noexcept {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double determinant = left - right, sizes = std::abs(left) + std::abs(right);
  if (std::abs(determinant) > kBound2 * sizes && sizes > kSmall) return sign_of(determinant);
  return exact_orientation(a, b, c);
}

}  // namespace ist
