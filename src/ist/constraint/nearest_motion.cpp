#include "ist/constraint/nearest_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ist {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kMostSteps = 200;
// A pivot of the metric is at least this part of the largest one.
constexpr double kLeastPivot = 1e-14;
// A direction whose square across the active bounds is a smaller part of it depends on them.
constexpr double kDependent = 1e-16;
// A smaller part of an active bound in another one counts as none.
constexpr double kNoPart = 1e-12;

template <std::size_t n>
double dot(const double (&a)[n], const double (&b)[n]) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

NearestMotion::NearestMotion(std::size_t room) { bounds_.reserve(room); }

bool NearestMotion::add(const Vector6& along, double least) noexcept {
  if (bounds_.size() == bounds_.capacity()) return false;
  Bound& bound = bounds_.emplace_back();
  std::copy_n(along.data(), kSize, bound.along);
  bound.least = least;
  return true;
}

// The Cholesky factor. A metric without stiffness in some direction gets a little.
void NearestMotion::factor(const Matrix6& metric) noexcept {
  double largest = 0;
  for (Eigen::Index i = 0; i < 6; ++i) largest = std::max(largest, metric(i, i));
  const double least = largest > 0 ? kLeastPivot * largest : 1;
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = metric(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      for (std::size_t k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
      factor_[i][j] = i == j ? std::sqrt(std::max(sum, least)) : sum / factor_[j][j];
    }
  }
}

void NearestMotion::project(const Vector& along, Vector& rest, Vector& parts) noexcept {
  // Modified Gram and Schmidt: q are the active bounds made orthonormal, r their triangle.
  double q[kSize][kSize], r[kSize][kSize], on[kSize];
  std::copy_n(along, kSize, rest);
  for (std::size_t k = 0; k < active_; ++k) {
    std::copy_n(bounds_[pushes_[k].bound].scaled, kSize, q[k]);
    for (std::size_t i = 0; i < k; ++i) {
      r[i][k] = dot(q[i], q[k]);
      for (std::size_t c = 0; c < kSize; ++c) q[k][c] -= r[i][k] * q[i][c];
    }
    r[k][k] = std::sqrt(dot(q[k], q[k]));
    for (double& c : q[k]) c /= r[k][k];
    on[k] = dot(q[k], rest);
    for (std::size_t c = 0; c < kSize; ++c) rest[c] -= on[k] * q[k][c];
  }
  // Once more, since the first pass leaves rounding along the active bounds.
  for (std::size_t k = 0; k < active_; ++k) {
    const double left = dot(q[k], rest);
    on[k] += left;
    for (std::size_t c = 0; c < kSize; ++c) rest[c] -= left * q[k][c];
  }
  for (std::size_t k = active_; k-- > 0;) {
    double sum = on[k];
    for (std::size_t i = k + 1; i < active_; ++i) sum -= r[k][i] * parts[i];
    parts[k] = sum / r[k][k];
  }
}

void NearestMotion::drop(std::size_t active) noexcept {
  for (std::size_t k = active; k + 1 < active_; ++k) pushes_[k] = pushes_[k + 1];
  --active_;
}

bool NearestMotion::solve(const Matrix6& metric, const Vector6& wanted, double tolerance) noexcept {
  active_ = 0;
  feasible_ = bounds_.empty();
  motion_ = feasible_ ? wanted : Vector6(Vector6::Zero());
  if (feasible_) return true;
  factor(metric);
  // In y = Lᵀ m the metric is the identity.
  Vector y;
  for (std::size_t i = 0; i < kSize; ++i) {
    y[i] = 0;
    for (std::size_t k = i; k < kSize; ++k) {
      y[i] += factor_[k][i] * wanted[static_cast<Eigen::Index>(k)];
    }
  }
  for (Bound& bound : bounds_) {
    for (std::size_t i = 0; i < kSize; ++i) {
      double sum = bound.along[i];
      for (std::size_t k = 0; k < i; ++k) sum -= factor_[i][k] * bound.scaled[k];
      bound.scaled[i] = sum / factor_[i][i];
    }
  }
  bool solved = false;
  for (int step = 0; step < kMostSteps && !solved; ++step) {
    // The bound that is violated most.
    std::size_t worst = bounds_.size();
    double most = tolerance;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      const double missing = bounds_[i].least - dot(bounds_[i].scaled, y);
      if (missing > most) {
        most = missing;
        worst = i;
      }
    }
    if (worst == bounds_.size()) {
      solved = true;
      break;
    }
    const Vector& along = bounds_[worst].scaled;
    double force = 0;
    for (; step < kMostSteps; ++step) {
      Vector rest, parts;
      project(along, rest, parts);
      // The push ends if an active bound lets go, or if the bound is met.
      double least = kNever;
      std::size_t vanishes = active_;
      for (std::size_t k = 0; k < active_; ++k) {
        if (parts[k] > kNoPart && pushes_[k].force < least * parts[k]) {
          least = pushes_[k].force / parts[k];
          vanishes = k;
        }
      }
      const double across = dot(rest, rest);
      const double missing = bounds_[worst].least - dot(along, y);
      const bool is_free = active_ < kSize && across > kDependent * dot(along, along);
      const double full = is_free ? missing / across : kNever;
      const double push = std::min(least, full);
      if (push == kNever) {  // no motion obeys this bound and the active ones
        active_ = 0;
        return false;
      }
      if (is_free) {
        for (std::size_t c = 0; c < kSize; ++c) y[c] += push * rest[c];
      }
      for (std::size_t k = 0; k < active_; ++k) {
        pushes_[k].force = std::max(0.0, pushes_[k].force - push * parts[k]);
      }
      force += push;
      if (push == full) {
        pushes_[active_++] = {worst, force};
        break;
      }
      drop(vanishes);
    }
  }
  if (!solved) {
    active_ = 0;
    return false;
  }
  feasible_ = true;
  for (std::size_t i = kSize; i-- > 0;) {
    double sum = y[i];
    for (std::size_t k = i + 1; k < kSize; ++k) {
      sum -= factor_[k][i] * motion_[static_cast<Eigen::Index>(k)];
    }
    motion_[static_cast<Eigen::Index>(i)] = sum / factor_[i][i];
  }
  return true;
}

}  // namespace ist
