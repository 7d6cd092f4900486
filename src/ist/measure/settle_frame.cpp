#include "ist/measure/settle_frame.h"

#include <cmath>

#include "ist/base/angles.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Below this angle the last coefficient is taken from its series.
constexpr double kSmall = 1e-3;

// exp [r] = 1 + first [r] + second [r]², and its left Jacobian is 1 + second [r] + third [r]².
struct Coefficients {
  double first, second, third;
};

Coefficients coefficients_of(double angle) noexcept {
  if (!(angle > 0)) return {1, 0.5, 1.0 / 6};
  const double square = angle * angle;
  const auto [half_sine, half_cosine] = sine_cosine(0.5 * angle);
  const double first = 2 * half_sine * half_cosine / angle;
  const double second = 2 * half_sine * half_sine / square;
  const double third = angle < kSmall ? 1.0 / 6 - square / 120 : (1 - first) / square;
  return {first, second, third};
}

Vector frame_vector(const double (&from)[3]) noexcept { return {from[0], from[1], from[2]}; }

Vector turn_of(const Vector6& at) noexcept { return {at[3], at[4], at[5]}; }

// v + a [r] v + b [r]² v
Vector turned(const Vector& r, const Vector& v, double a, double b) noexcept {
  const Vector once = cross_in_order(r, v), twice = cross_in_order(r, once);
  return sum(sum(v, scaled(a, once)), scaled(b, twice));
}

}  // namespace

SettleFrame::SettleFrame(const Eigen::Isometry3d& pose, const Vector& load) noexcept {
  const Vector place = RigidMove(pose)(load);
  for (Eigen::Index i = 0; i < 3; ++i) {
    load_[i] = load[i];
    place_[i] = place[i];
    for (Eigen::Index j = 0; j < 3; ++j) rotation_[i][j] = pose.linear()(i, j);
  }
}

Vector SettleFrame::load_at(const Vector6& at) const noexcept {
  return {place_[0] + at[0], place_[1] + at[1], place_[2] + at[2]};
}

Eigen::Isometry3d SettleFrame::pose_at(const Vector6& at) const noexcept {
  const Vector r = turn_of(at);
  const Coefficients c = coefficients_of(length_in_order(r));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Vector column(rotation_[0][j], rotation_[1][j], rotation_[2][j]);
    pose.linear().col(j) = turned(r, column, c.first, c.second);
  }
  pose.translation() = difference(load_at(at), RigidMove(pose).turned(frame_vector(load_)));
  return pose;
}

Vector SettleFrame::turn_at(const Vector6& at, const Vector& change) const noexcept {
  const Vector r = turn_of(at);
  const Coefficients c = coefficients_of(length_in_order(r));
  return turned(r, change, c.second, c.third);
}

Vector6 SettleFrame::bound_at(const Vector6& at, const Vector& normal,
                              const Vector& arm) const noexcept {
  const Vector r = turn_of(at);
  const Coefficients c = coefficients_of(length_in_order(r));
  // The transpose of the Jacobian: [r] changes its sign.
  const Vector moment = turned(r, cross_in_order(arm, normal), -c.second, c.third);
  Vector6 bound;
  for (Eigen::Index i = 0; i < 3; ++i) {
    bound[i] = normal[i];
    bound[3 + i] = moment[i];
  }
  return bound;
}

}  // namespace ist
