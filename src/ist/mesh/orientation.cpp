#include "ist/mesh/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ist/mesh/whole_number.h"

namespace ist {
namespace {

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
