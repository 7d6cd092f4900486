#include "ist/sweep/pose_box.h"

#include <fmt/format.h>

#include <cmath>

#include "ist/sweep/bit_text.h"
#include "ist/sweep/philox.h"
#include "ist/sweep/turn.h"

namespace ist {
namespace {

// A number from [-1, 1).
double signed_uniform(Philox& random) { return 2 * random.uniform() - 1; }

struct Disc {
  double x, y, square;
};

// A point inside the unit circle, the centre excepted.
Disc point_of_disc(Philox& random) {
  while (true) {
    const double x = signed_uniform(random), y = signed_uniform(random);
    const double square = x * x + y * y;
    if (square < 1 && square > 0) return {x, y, square};
  }
}

Eigen::Matrix3d any_turn(Philox& random) {
  const Disc a = point_of_disc(random), b = point_of_disc(random);
  const double scale = std::sqrt((1 - a.square) / b.square);
  return rotation_of(a.x, a.y, b.x * scale, b.y * scale);
}

Eigen::Matrix3d small_turn(Philox& random, const Eigen::Vector3d& within) {
  Eigen::Vector3d half;
  for (int axis = 0; axis < 3; ++axis) {
    half[axis] = 0.5 * (signed_uniform(random) * (within[axis] * kRadiansPerDegree));
  }
  return rotation_of(1, half[0], half[1], half[2]);
}

}  // namespace

Eigen::Isometry3d PoseBox::pose(std::uint64_t index) const {
  Philox random(settings_.seed, index);
  Eigen::Vector3d move;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = settings_.from[axis], to = settings_.to[axis];
    move[axis] = from + random.uniform() * (to - from);
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (settings_.turns == Turns::kAny) {
    pose = turn_about(any_turn(random), settings_.about);
  } else if (settings_.turns == Turns::kWithin) {
    pose = turn_about(small_turn(random, settings_.within), settings_.about);
  }
  for (int axis = 0; axis < 3; ++axis) pose(axis, 3) += move[axis];
  return pose;
}

void PoseBox::read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const {
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose(first + i);
}

std::string PoseBox::identity() const {
  return fmt::format("box seed {} count {} from {} to {} turns {} within {} about {}",
                     settings_.seed, settings_.count, bits_of(settings_.from),
                     bits_of(settings_.to), static_cast<int>(settings_.turns),
                     bits_of(settings_.within), bits_of(settings_.about));
}

}  // namespace ist
