#include "sweep/pose_source.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "ist/base/angles.h"
#include "ist/base/direction.h"
#include "ist/base/ordered_vector.h"
#include "sweep/philox.h"

namespace ist {
namespace {

// Turns by + - × ÷ alone: their bits are the same everywhere.
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

// Returns the rotation of the quaternion w + x i + y j + z k, of any length but 0.
Eigen::Matrix3d rotation_of(double w, double x, double y, double z) noexcept {
  const double scale = 2 / ((w * w + x * x) + (y * y + z * z));
  const double xx = scale * x * x, yy = scale * y * y, zz = scale * z * z;
  const double xy = scale * x * y, xz = scale * x * z, yz = scale * y * z;
  const double wx = scale * w * x, wy = scale * w * y, wz = scale * w * z;
  Eigen::Matrix3d rotation;
  rotation << 1 - (yy + zz), xy - wz, xz + wy,  //
      xy + wz, 1 - (xx + zz), yz - wx,          //
      xz - wy, yz + wx, 1 - (xx + yy);
  return rotation;
}

// Returns the motion that turns about the point `about`.
Eigen::Isometry3d turn_about(const Eigen::Matrix3d& rotation,
                             const Eigen::Vector3d& about) noexcept {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation;
  for (int row = 0; row < 3; ++row) {
    motion(row, 3) = about[row] - dot_in_order(rotation.row(row), about);
  }
  return motion;
}

Eigen::Isometry3d motion_of(const PoseGrid::Axis& axis, double value) {
  if (axis.turns) {
    const auto [sine, cosine] = sine_cosine(0.5 * value * kRadiansPerDegree);
    const Eigen::Vector3d part = scaled(sine, axis.direction);
    return turn_about(rotation_of(cosine, part[0], part[1], part[2]), axis.about);
  }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = scaled(value, axis.direction);
  return motion;
}

// `second` after `first`, each sum in one order.
Eigen::Isometry3d composed(const Eigen::Isometry3d& second, const Eigen::Isometry3d& first) {
  Eigen::Isometry3d both = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d turn = second.linear().row(row);
    for (int column = 0; column < 4; ++column) {
      both(row, column) = dot_in_order(turn, first.matrix().col(column).head<3>());
    }
    both(row, 3) += second(row, 3);
  }
  return both;
}

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

PoseGrid::PoseGrid(std::vector<Axis> axes) : axes_(std::move(axes)) {
  for (Axis& axis : axes_) {
    if (const auto along = direction_of(axis.direction)) axis.direction = along->unit;
    count_ *= axis.count;
  }
}

double PoseGrid::value_of(const Axis& axis, std::uint64_t step) noexcept {
  if (step == 0) return axis.from;
  if (step == axis.count - 1) return axis.to;
  return axis.from +
         (axis.to - axis.from) * (static_cast<double>(step) / static_cast<double>(axis.count - 1));
}

Eigen::Isometry3d PoseGrid::pose(std::uint64_t index) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = axes_.size(); i-- > 0;) {
    const Axis& axis = axes_[i];
    pose = composed(motion_of(axis, value_of(axis, index % axis.count)), pose);
    index /= axis.count;
  }
  return pose;
}

void PoseGrid::read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const {
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose(first + i);
}

std::string PoseGrid::identity() const {
  std::string text = "grid";
  for (const Axis& axis : axes_) {
    text += fmt::format(" {} {} about {} from {} to {} count {}", axis.turns ? "turn" : "move",
                        bits_of(axis.direction), bits_of(axis.about), bits_of(axis.from),
                        bits_of(axis.to), axis.count);
  }
  return text;
}

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
