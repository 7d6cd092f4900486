#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/pose.h"

namespace ist {

/// Finds the motion of a body that is nearest to a wanted one and obeys linear bounds:
///
///     minimise (m - wanted)ᵀ S (m - wanted) / 2   with   aᵢ · m >= bᵢ
///
/// The multipliers fᵢ >= 0 of the bounds are the contact forces: S (m - wanted) = Σ fᵢ aᵢ. The
/// result does not depend on rounding modes or instruction sets: it uses + - * / and square roots
/// in a fixed order.
///
/// Source: D. Goldfarb and A. Idnani, A numerically stable dual method for solving strictly convex
/// quadratic programs, Mathematical Programming 27, 1983. At most six bounds are active.
class IST_LOOP_API NearestMotion {
 public:
  /// Reserves room for `room` bounds.
  explicit NearestMotion(std::size_t room);

  /// Removes all bounds.
  void clear() noexcept { bounds_.clear(); }
  /// Adds the bound along · m >= least, m and rad. Returns whether there was room.
  bool add(const Vector6& along, double least) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return bounds_.size(); }

  /// Solves the problem. Returns whether a motion obeys the bounds. motion() is then the nearest,
  /// else 0.
  /// @param metric    S, symmetric and positive definite: N/m, N and N m
  /// @param wanted    the motion without bounds
  /// @param tolerance a bound may be violated by so much, m
  /// Cost: 0.5 µs, 0.1 µs a bound, and 1 µs an active bound.
  bool solve(const Matrix6& metric, const Vector6& wanted, double tolerance) noexcept;
  [[nodiscard]] const Vector6& motion() const noexcept { return motion_; }
  /// Whether the last problem had a solution.
  [[nodiscard]] bool is_feasible() const noexcept { return feasible_; }

  /// A bound that pushes.
  struct Push {
    std::size_t bound;  ///< in the order of add()
    double force;       ///< fᵢ
  };
  /// The bounds that push at motion(), at most six.
  [[nodiscard]] std::span<const Push> pushes() const noexcept { return {pushes_, active_}; }
  [[nodiscard]] std::size_t bytes() const noexcept { return bounds_.capacity() * sizeof(Bound); }

 private:
  static constexpr std::size_t kSize = 6;
  using Vector = double[kSize];
  struct Bound {
    double along[kSize], least;
    double scaled[kSize];  // L⁻¹ along, of the metric L Lᵀ
  };

  void factor(const Matrix6& metric) noexcept;
  // Splits `along` into parts of the active bounds and a rest across them.
  void project(const Vector& along, Vector& rest, Vector& parts) noexcept;
  void drop(std::size_t active) noexcept;

  std::vector<Bound> bounds_;
  double factor_[kSize][kSize];  // L
  std::size_t active_ = 0;
  Push pushes_[kSize];
  Vector6 motion_ = Vector6::Zero();
  bool feasible_ = true;
};

}  // namespace ist
