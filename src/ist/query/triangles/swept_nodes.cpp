#include "ist/query/triangles/swept_nodes.h"

#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// More than the rounding of float takes from a bound, of its size.
constexpr double kWiden = 1 + 0x1p-18;

}  // namespace

Vector ScrewPart::velocity(const Vector& at) const noexcept {
  return sum(cross_in_order(turning, at), drift);
}

double ScrewPart::bend(double fastest) const noexcept {
  return ((0.5 * length_in_order(turning)) * fastest) * (half * half);
}

Sweep::Sweep(const ScrewPart& part, const TriangleClusters& fixed) noexcept
    : half_(part.half),
      turn_(part.half * length_in_order(part.turning)),
      bend_(part.bend(part.speed)) {
  const Eigen::Matrix3d& axes = fixed.axes();
  const Vector at_origin = part.velocity(fixed.origin());
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Vector across = cross_in_order(part.turning, axes.col(j));
    for (Eigen::Index i = 0; i < 3; ++i) turning_[i][j] = dot_in_order(axes.col(i), across);
  }
  for (Eigen::Index i = 0; i < 3; ++i) drift_[i] = dot_in_order(axes.col(i), at_origin);
}

void Sweep::widen(TurnedBlock& lanes) const noexcept {
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    double centre[3], velocity[3];
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] = double{lanes.centre[i][lane]} + double{lanes.rest[i][lane]};
    }
    // The velocity in a node differs from its centre's by its radius times the turning.
    const double more = turn_ * double{lanes.radius[lane]} + bend_;
    double along = 0, square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& t = turning_[i];
      velocity[i] = ((t[0] * centre[0] + t[1] * centre[1]) + t[2] * centre[2]) + drift_[i];
      along += velocity[i] * double{lanes.normal[i][lane]};
      square += velocity[i] * velocity[i];
      const auto by = static_cast<float>(kWiden * (std::abs(velocity[i]) * half_ + more));
      lanes.low[i][lane] -= by;
      lanes.high[i][lane] += by;
    }
    const auto all = static_cast<float>(kWiden * (std::sqrt(square) * half_ + more));
    lanes.thickness[lane] += static_cast<float>(
        kWiden * ((std::abs(along) + 0x1p-20 * std::sqrt(square)) * half_ + more));
    lanes.rim[lane] += all;
    lanes.radius[lane] += all;
  }
}

}  // namespace ist
