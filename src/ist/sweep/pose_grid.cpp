#include "ist/sweep/pose_grid.h"

#include <fmt/format.h>

#include <utility>

#include "ist/base/angles.h"
#include "ist/base/direction.h"
#include "ist/base/ordered_vector.h"
#include "ist/sweep/bit_text.h"
#include "ist/sweep/turn.h"

namespace ist {
namespace {

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

}  // namespace ist
