#include "ist/hardware/quantized_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hardware/table_words.h"
#include "ist/base/compensated.h"
#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"
#include "ist/hardware/table_rom.h"
#include "ist/tree/implicit_ball.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

constexpr double kUnitsPerVoxel = 12;
constexpr double kLsb = 0x1p-8;  // last bit of a distance, units
// Rounding error of an entry in Q3.16 and in Q3.28, with the error of the double before it.
constexpr double kOfRotation = 0x1p-17 + 0x1p-48, kOfFineRotation = 0x1p-29 + 0x1p-48;
// |x| + |y| + |z| of the table's centres, by radius code.
constexpr std::array<int, 5> kOffsetSums = {9, 6, 3, 6, 0};

constexpr bool offset_sums_hold() {
  for (const std::uint16_t word : kRomWords) {
    int sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int x = rom_coordinate(word, axis);
      sum += x < 0 ? -x : x;
    }
    if (rom_radius_code(word) != kNoRadius && sum != kOffsetSums[rom_radius_code(word)]) {
      return false;
    }
  }
  return true;
}
static_assert(offset_sums_hold());

[[noreturn]] void out_of_range(const std::string& text) {
  throw Error(ErrorCode::kFixedPointRange, text);
}

double nearest(double x) noexcept { return std::floor(x + 0.5); }

// Rounds to a signed number of `bits` bits, `fraction` of them after the point.
std::int64_t to_fixed_point(double value, int bits, int fraction, const char* what) {
  const double scaled = nearest(value * static_cast<double>(std::int64_t{1} << fraction));
  const auto end = static_cast<double>(std::int64_t{1} << (bits - 1));
  if (!(scaled >= -end && scaled < end)) {
    out_of_range(
        fmt::format("{}: {:.6g} does not fit {} bits with {} after the point: use voxel sizes "
                    "closer to each other, or bodies closer to each other",
                    what, value, bits, fraction));
  }
  return static_cast<std::int64_t>(scaled);
}

struct Motion {
  Eigen::Vector3d translation;  // between the trees' frames, fixed units
  double error;                 // of each coordinate
};

// Returns the translation as relative_pose composes it, and its error bound.
Motion frame_motion(const Eigen::Isometry3d& rigid, const Lattice& fixed, const Lattice& moving) {
  const double fixed_half = 0.5 * fixed.edge(fixed.depth);
  const double moving_half = 0.5 * moving.edge(moving.depth);
  Motion motion{{}, 0};
  for (Eigen::Index i = 0; i < 3; ++i) {
    CompensatedSum sum;
    double terms = 0;
    const auto add = [&](double a, double b) {
      sum.add_product(a, b);
      terms += std::abs(a * b);
    };
    add(1, rigid.translation()[i]);
    add(-1, fixed.corner[static_cast<std::size_t>(i)]);
    add(-1, fixed_half);
    for (Eigen::Index j = 0; j < 3; ++j) {
      add(rigid.linear()(i, j), moving.corner[static_cast<std::size_t>(j)]);
      add(rigid.linear()(i, j), moving_half);
    }
    const double unit = fixed.voxel_size / kUnitsPerVoxel;
    motion.translation[i] = sum.value() / unit;
    // The error: u of the sum and of each of two divisions, and 18²u² of its terms, the halves of
    // nine products; with room for the rounding of this bound.
    motion.error =
        std::max(motion.error, 0x1p-51 * std::abs(motion.translation[i]) + 0x1p-97 * terms / unit);
  }
  return motion;
}

// Returns the bound of a moved centre's error in any direction, units.
double pad_of(const Motion& motion, const Lattice& moving) noexcept {
  const double farthest = 0.5 * kUnitsPerVoxel * static_cast<double>(1u << moving.depth);
  const double of_product = 3 * farthest * kOfFineRotation;
  const double of_translation = 0x1p-29 + motion.error;
  constexpr double kTwoFloors = 2 * kLsb;
  return kSqrt3 * (kTwoFloors + of_product + of_translation);
}

}  // namespace

PairRegisters make_registers(const Eigen::Matrix3d& rotation, double ratio, std::uint16_t pad) {
  const ScopedFloatEnvironment environment;
  if (!(ratio > 0 && ratio < 8)) {
    out_of_range(
        fmt::format("the moving voxels are {:.6g} times as large as the fixed ones, and the "
                    "registers hold less than 8: let the body with the larger voxels be the fixed "
                    "one, or use voxel sizes closer to each other",
                    ratio));
  }
  PairRegisters registers;
  registers.pad = pad;
  for (Eigen::Index k = 0; k < 9; ++k) {
    registers.rotation[static_cast<std::size_t>(k)] =
        static_cast<std::int32_t>(to_fixed_point(rotation.data()[k] * ratio, 20, 16, "rotation"));
  }
  for (std::size_t code = 0; code < registers.radius.size(); ++code) {
    const double of_offset = kSqrt3 * kOfRotation * kOffsetSums[code];
    const double radius = ratio * std::sqrt(static_cast<double>(kRadiusSquared[code])) + of_offset;
    constexpr double kRoom = 1 + 0x1p-48;  // for the rounding of this expression
    registers.radius[code] = static_cast<std::uint16_t>(std::ceil(radius * kRoom / kLsb));
  }
  return registers;
}

QuantizedPose quantize_pose(const Eigen::Isometry3d& pose, const Lattice& fixed,
                            const Lattice& moving) {
  const ScopedFloatEnvironment environment;
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) {
    throw_error(ErrorCode::kPoseInvalid, "the pose is not a rigid motion: {}", why_not_rigid(pose));
  }
  const Motion motion = frame_motion(*rigid, fixed, moving);
  const double pad = std::ceil(pad_of(motion, moving) / kLsb);
  if (!(pad <= 0xFFFF)) {
    out_of_range(
        "the pad for bodies this far from the origin does not fit its 16 bits: move both bodies "
        "closer to the origin");
  }
  const double ratio = moving.voxel_size / fixed.voxel_size;
  const Eigen::Matrix3d rotation = rigid->linear();
  QuantizedPose quantized;
  quantized.registers = make_registers(rotation, ratio, static_cast<std::uint16_t>(pad));
  for (Eigen::Index k = 0; k < 9; ++k) {
    quantized.rotation[static_cast<std::size_t>(k)] =
        static_cast<std::int32_t>(to_fixed_point(rotation.data()[k] * ratio, 32, 28, "rotation"));
  }
  const std::int64_t farthest = std::int64_t{6} << moving.depth;
  for (std::size_t i = 0; i < 3; ++i) {
    quantized.translation[i] =
        to_fixed_point(motion.translation[static_cast<Eigen::Index>(i)], 52, 28, "translation");
    std::int64_t reach = std::abs(quantized.translation[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      reach += std::abs(std::int64_t{quantized.rotation[3 * k + i]}) * farthest;
    }
    if (reach >= std::int64_t{1} << 51) {
      out_of_range(
          "a moved centre would not fit 32 bits with 8 after the point: the bodies are hundreds of "
          "thousands of fixed voxels apart: use larger fixed voxels, or bodies closer to each "
          "other");
    }
  }
  return quantized;
}

std::array<std::int32_t, 3> move_centre(const QuantizedPose& pose,
                                        const std::array<std::int32_t, 3>& centre) noexcept {
  std::array<std::int32_t, 3> moved{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t sum = pose.translation[i];
    for (std::size_t k = 0; k < 3; ++k) {
      sum += std::int64_t{pose.rotation[3 * k + i]} * centre[k];
    }
    moved[i] = static_cast<std::int32_t>(sum >> 20);
  }
  return moved;
}

QuantizedPose quantize_pose(const Eigen::Isometry3d& pose, const SphereTree& fixed,
                            const SphereTree& moving) {
  fixed.require(SpherePolicy::kSimple, "fixed");  // the circuit reads voxels
  moving.require(SpherePolicy::kSimple, "moving");
  return quantize_pose(pose, voxels_of(fixed).lattice, voxels_of(moving).lattice);
}

}  // namespace ist
