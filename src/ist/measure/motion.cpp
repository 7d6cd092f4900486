
#include <algorithm>
#include <cmath>
#include <optional>

#include "ist/base/angles.h"
#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/pose.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/require.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Farther poses, and longer ways, cannot be told from each other.
constexpr double kFarthestPose = 1e15;

void require_near(double number, const char* name) {
  if (std::abs(number) <= kFarthestPose) return;  // no NaN
  throw_error(ErrorCode::kArgumentInvalid,
              "{}: {} is not finite, or beyond {:g}: give a nearer motion", name, number,
              kFarthestPose);
}

void store(const Vector& from, double (&to)[3]) {
  for (Eigen::Index i = 0; i < 3; ++i) to[i] = from[i];
}

Vector vector(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

}  // namespace

Motion Motion::between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const ScopedFloatEnvironment environment;
  const Eigen::Isometry3d first = require_rigid(from, "from"), last = require_rigid(to, "to");
  require_near(last.translation().cwiseAbs().maxCoeff(), "to");
  Eigen::Quaterniond turn(Eigen::Matrix3d(last.linear() * first.linear().transpose()));
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const Vector imaginary = turn.vec();
  const double sine = std::sqrt(dot_in_order(imaginary, imaginary));  // of half the angle
  Motion motion = screw(from, Vector(0, 0, 0), Vector(0, 0, 1), 0, 0);
  motion.rotation_error_ = std::max(motion.rotation_error_, ist::rotation_error(to));
  const Vector shift =
      last.translation() - last.linear() * first.linear().transpose() * first.translation();
  if (!(sine > 0)) {
    const std::optional<Direction> way = direction_of(shift);
    motion.along_ = way ? way->length : 0;
    if (way) store(way->unit, motion.axis_);
    return motion;
  }
  // Where the axis is, by the shift across it: c = (u + cot(angle / 2) axis × u) / 2.
  const Vector axis = scaled(1 / sine, imaginary);
  motion.angle_ = 2 * angle_of(sine, turn.w());
  motion.along_ = dot_in_order(axis, shift);
  const Vector u = difference(shift, scaled(motion.along_, axis)), w = cross_in_order(axis, u);
  const double cotangent = turn.w() / sine;
  store(axis, motion.axis_);
  store(scaled(0.5, sum(u, scaled(cotangent, w))), motion.centre_);
  store(scaled(0.5, difference(w, scaled(cotangent, u))), motion.across_);
  return motion;
}

Motion Motion::screw(const Eigen::Isometry3d& from, const Vector& point, const Vector& direction,
                     double angle, double along) {
  const ScopedFloatEnvironment environment;
  const Eigen::Isometry3d first = require_rigid(from, "from");
  require_near(first.translation().cwiseAbs().maxCoeff(), "from");
  require_near(point.cwiseAbs().maxCoeff(), "point");
  require_near(angle, "angle");
  require_near(along, "along");
  const std::optional<Direction> towards = direction_of(direction);
  if (!towards) {
    throw_error(ErrorCode::kArgumentInvalid,
                "direction: ({}, {}, {}) is {}: give another, or a translation", direction[0],
                direction[1], direction[2], direction.allFinite() ? "0" : "not finite");
  }
  Motion motion;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) motion.rotation_[i][j] = first.linear()(i, j);
    motion.translation_[i] = first.translation()[i];
  }
  const Vector& axis = towards->unit;
  const Vector centre = difference(point, scaled(dot_in_order(axis, point), axis));
  store(axis, motion.axis_);
  store(centre, motion.centre_);
  store(cross_in_order(axis, centre), motion.across_);
  motion.angle_ = angle;
  motion.along_ = along;
  motion.rotation_error_ = ist::rotation_error(from);
  return motion;
}

Eigen::Isometry3d Motion::at(double parameter) const noexcept {
  const ScopedFloatEnvironment environment;
  const auto [s, c] = sine_cosine(0.5 * parameter * angle_);
  const double sine = 2 * s * c, versine = 2 * s * s;  // 1 - cosine
  const Vector axis = vector(axis_);
  // R = 1 + sine [axis] + versine [axis]², by columns.
  const auto turned = [&](const Vector& v) {
    const Vector once = cross_in_order(axis, v), twice = cross_in_order(axis, once);
    return sum(sum(v, scaled(sine, once)), scaled(versine, twice));
  };
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index j = 0; j < 3; ++j) {
    pose.linear().col(j) = turned({rotation_[0][j], rotation_[1][j], rotation_[2][j]});
  }
  Vector at = turned(vector(translation_));
  add_to(at, difference(scaled(versine, vector(centre_)), scaled(sine, vector(across_))));
  add_to(at, scaled(parameter * along_, axis));
  pose.translation() = at;
  return pose;
}

Vector Motion::velocity(const Vector& point) const noexcept {
  const ScopedFloatEnvironment environment;
  const Vector axis = vector(axis_);
  const Vector turning = difference(cross_in_order(axis, point), vector(across_));
  return sum(scaled(angle_, turning), scaled(along_, axis));
}

double Motion::longest_way(std::span<const Vector> points) const noexcept {
  const ScopedFloatEnvironment environment;
  const RigidMove first(at(0));
  const Vector axis = vector(axis_), across = vector(across_), along = scaled(along_, axis);
  double longest = 0;  // its square
  for (const Vector& point : points) {
    const Vector turning = scaled(angle_, difference(cross_in_order(axis, first(point)), across));
    const Vector way = sum(turning, along);
    longest = std::max(longest, dot_in_order(way, way));
  }
  return std::sqrt(longest);
}

}  // namespace ist
