#include "hardware/exact_pair.h"

#include <cmath>

#include "ist/tree/lookup_table.h"
#include "query/query_cases.h"
#include "support/rigid_pose.h"

namespace ist::test {
namespace {

TableBall ball_of(const HardwareNode& node) { return kLookupTable[node.mask]; }

std::array<mpq_class, 3> ball_centre(const HardwareNode& node) {
  const TableBall ball = ball_of(node);
  const mpz_class scale = mpz_class(1) << static_cast<unsigned>(node.level);
  return {mpq_class(node.centre[0] + scale * ball.x), mpq_class(node.centre[1] + scale * ball.y),
          mpq_class(node.centre[2] + scale * ball.z)};
}

mpq_class radius_squared(const HardwareNode& node, const mpq_class& unit) {
  const mpq_class scale = unit * (mpz_class(1) << static_cast<unsigned>(node.level));
  return scale * scale * int{ball_of(node).radius_squared};
}

Eigen::Vector3d rounded_ball_centre(const HardwareNode& node) {
  Eigen::Vector3d centre;
  const std::array<mpq_class, 3> exact_centre = ball_centre(node);
  for (Eigen::Index i = 0; i < 3; ++i) {
    centre[i] = exact_centre[static_cast<std::size_t>(i)].get_d();
  }
  return centre;
}

}  // namespace

ExactFrames::ExactFrames(const Eigen::Isometry3d& pose, const Lattice& fixed, const Lattice& moving)
    : ratio_(mpq_class(moving.voxel_size) / mpq_class(fixed.voxel_size)) {
  const Eigen::Isometry3d rigid = rigid_pose(pose);
  const ExactPoint of_fixed = frame_origin(fixed), of_moving = frame_origin(moving);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < 3; ++j) {
      rows_[i][j] = mpq_class(rigid.linear()(row, static_cast<Eigen::Index>(j)));
    }
    translation_[i] =
        (mpq_class(rigid.translation()[row]) - of_fixed[i] + dot(rows_[i], of_moving)) * 12 /
        mpq_class(fixed.voxel_size);
  }
  for (ExactPoint& row : rows_) row = ratio_ * row;
}

ExactPoint ExactFrames::moved(const std::array<mpq_class, 3>& centre) const {
  ExactPoint result = translation_;
  for (std::size_t i = 0; i < 3; ++i) result[i] += dot(rows_[i], ExactPoint{centre});
  return result;
}

ExactPoint ExactFrames::between(const HardwareNode& fixed, const HardwareNode& moving) const {
  return moved(ball_centre(moving)) - ExactPoint{ball_centre(fixed)};
}

// d <= (rA + rB) s, squared twice: rA² and rB² are rational, and rA and rB are not.
bool ExactFrames::touch(const HardwareNode& fixed, const HardwareNode& moving,
                        const mpq_class& scale) const {
  const mpq_class a = scale * scale * radius_squared(fixed, 1);
  const mpq_class b = scale * scale * radius_squared(moving, ratio_);
  const mpq_class rest = square(between(fixed, moving)) - a - b;
  return rest <= 0 || rest * rest <= 4 * a * b;
}

Lattice centred_lattice(int depth, double voxel_size) {
  Lattice lattice;
  lattice.depth = depth;
  lattice.cells = 1u << depth;
  lattice.voxel_size = voxel_size;
  lattice.corner.fill(-0.5 * voxel_size * lattice.cells);
  return lattice;
}

HardwareNode random_node(Random& random, int depth, int level) {
  HardwareNode node;
  node.level = level;
  node.mask = static_cast<std::uint8_t>(1 + random.below(255));
  for (std::int32_t& x : node.centre) {
    const auto cube = static_cast<std::int32_t>(random.below(std::size_t{1} << (depth - level)));
    x = 12 * (cube << level) + (6 << level) - (6 << depth);
  }
  return node;
}

Eigen::Isometry3d pose_at(const Eigen::Matrix3d& rotation, const Lattice& fixed_lattice,
                          const Lattice& moving_lattice, const HardwareNode& fixed,
                          const HardwareNode& moving, const Eigen::Vector3d& direction,
                          double part) {
  const auto radius = [](const HardwareNode& node) {
    return std::sqrt(static_cast<double>(ball_of(node).radius_squared)) * std::ldexp(1, node.level);
  };
  const double unit = fixed_lattice.voxel_size / 12, moving_unit = moving_lattice.voxel_size / 12;
  const double apart = part * (unit * radius(fixed) + moving_unit * radius(moving));
  return pose_of(rotation, unit * rounded_ball_centre(fixed) + apart * direction -
                               rotation * (moving_unit * rounded_ball_centre(moving)));
}

}  // namespace ist::test
