#include "ist/query/triangles/sweep.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// More than the rounding of float takes from a bound, of its size.
constexpr double kWiden = 1 + 0x1p-18;
// A normal errs by less than this.
constexpr double kNormal = 0x1p-18;
// The bounds of two nodes err by less than this part of their sizes.
constexpr double kSlack = 0x1p-18;

struct Centre {
  double of[3];
};
Centre centre_of(const TurnedBlock& lanes, std::size_t lane) {
  Centre centre;
  for (std::size_t i = 0; i < 3; ++i) {
    centre.of[i] = double{lanes.centre[i][lane]} + double{lanes.rest[i][lane]};
  }
  return centre;
}

}  // namespace

Vector ScrewPart::velocity(const Vector& at) const noexcept {
  return sum(cross_in_order(turning, at), drift);
}

double ScrewPart::bend(double fastest) const noexcept {
  return (0.5 * length_in_order(turning)) * fastest;
}

Sweep::Sweep(const ScrewPart& part, const TriangleClusters& fixed) noexcept
    : half_(part.half),
      turn_(part.half * length_in_order(part.turning)),
      bend_(part.bend(part.speed) * (part.half * part.half)),
      pad_(part.pad) {
  const Eigen::Matrix3d& axes = fixed.axes();
  const Vector at_origin = part.velocity(fixed.origin());
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Vector across = cross_in_order(part.turning, axes.col(j));
    for (Eigen::Index i = 0; i < 3; ++i) turning_[i][j] = dot_in_order(axes.col(i), across);
  }
  for (Eigen::Index i = 0; i < 3; ++i) drift_[i] = dot_in_order(axes.col(i), at_origin);
}

Sweep::Velocity Sweep::velocity(const double (&at)[3]) const noexcept {
  Velocity v;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& t = turning_[i];
    v.of[i] = ((t[0] * at[0] + t[1] * at[1]) + t[2] * at[2]) + drift_[i];
  }
  return v;
}

void Sweep::widen(TurnedBlock& lanes) const noexcept {
  for (std::size_t lane = 0; lane < kClusterWidth; ++lane) {
    const Velocity v = velocity(centre_of(lanes, lane).of);
    // The velocity in a node differs from its centre's by its radius times the turning.
    const double more = turn_ * double{lanes.radius[lane]} + bend_;
    double along = 0, square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      along += v.of[i] * double{lanes.normal[i][lane]};
      square += v.of[i] * v.of[i];
      const auto by = static_cast<float>(kWiden * (std::abs(v.of[i]) * half_ + more));
      lanes.low[i][lane] -= by;
      lanes.high[i][lane] += by;
    }
    const double speed = std::sqrt(square);
    const auto all = static_cast<float>(kWiden * (speed * half_ + more));
    lanes.thickness[lane] +=
        static_cast<float>(kWiden * ((std::abs(along) + kNormal * speed) * half_ + more));
    lanes.rim[lane] += all;
    lanes.radius[lane] += all;
  }
}

// A widened bound leaves the other one's far side at the end of the part, for it goes evenly. So it
// came to the near side as much before as the bounds overlap.
double Sweep::meets_after(const TurnedBlock& lanes, std::size_t lane, const NodeBlock& fixed,
                          std::size_t node) const noexcept {
  const Centre centre = centre_of(lanes, lane);
  const Velocity v = velocity(centre.of);
  double apart[3], overlap[3], size = double{lanes.radius[lane]} + double{fixed.radius[node]};
  for (std::size_t i = 0; i < 3; ++i) {
    apart[i] = centre.of[i] - double{fixed.centre[i][node]};
    const double half = fixed.half[i][node];
    overlap[i] = v.of[i] < 0 ? half - (apart[i] + double{lanes.low[i][lane]})
                             : (apart[i] + double{lanes.high[i][lane]}) + half;
    size += std::abs(apart[i]);
  }
  const double slack = kSlack * size + pad_;
  double after = -half_;
  const auto take = [&](double deep, double speed) {
    if (speed > 0) after = std::max(after, half_ - (std::max(deep, 0.0) + slack) / speed);
  };
  for (std::size_t i = 0; i < 3; ++i) take(overlap[i], std::abs(v.of[i]));
  return after;
}

}  // namespace ist
