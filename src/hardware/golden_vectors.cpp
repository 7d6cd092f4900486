#include "hardware/golden_vectors.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "ist/base/float_environment.h"
#include "ist/hardware/quantized_pose.h"

namespace ist {
namespace {

// Returns the rotation of a quaternion, whose length is not 0.
Eigen::Matrix3d rotation_of(double w, double x, double y, double z) {
  const double s = 2 / (((w * w + x * x) + y * y) + z * z);
  Eigen::Matrix3d r;
  r(0, 0) = 1 - s * (y * y + z * z);
  r(1, 1) = 1 - s * (x * x + z * z);
  r(2, 2) = 1 - s * (x * x + y * y);
  r(0, 1) = s * (x * y - w * z);
  r(1, 0) = s * (x * y + w * z);
  r(0, 2) = s * (x * z + w * y);
  r(2, 0) = s * (x * z - w * y);
  r(1, 2) = s * (y * z - w * x);
  r(2, 1) = s * (y * z + w * x);
  return r;
}

}  // namespace

GoldenVector answered(GoldenVector vector) noexcept {
  vector.answer = test_pair(vector.pair, vector.registers);
  return vector;
}

std::optional<GoldenVector> at_distance(GoldenVector vector,
                                        const std::array<std::int64_t, 3>& distance) {
  vector.pair.moving_centre = {0, 0, 0};
  const std::array<std::int64_t, 3> from = ball_distance(vector.pair, vector.registers);
  for (std::size_t i = 0; i < 3; ++i) {
    using Limits = std::numeric_limits<std::int32_t>;
    const std::int64_t centre = distance[i] - from[i];
    if (centre < Limits::min() || centre > Limits::max()) return std::nullopt;
    vector.pair.moving_centre[i] = static_cast<std::int32_t>(centre);
  }
  return answered(vector);
}

GoldenVectors::GoldenVectors(std::uint64_t seed) : corners_(corner_cases()), state_(seed) {}

// SplitMix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators,
// OOPSLA 2014.
std::uint64_t GoldenVectors::bits() noexcept {
  std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

std::uint32_t GoldenVectors::below(std::uint32_t end) noexcept {
  return static_cast<std::uint32_t>((bits() >> 32) * end >> 32);
}

double GoldenVectors::between(double low, double high) noexcept {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

GoldenVector GoldenVectors::next() {
  const ScopedFloatEnvironment environment;
  if (given_ < corners_.size()) return corners_[given_++];
  ++given_;
  return random_vector(given_ % 2 == 0);
}

// Returns the registers of a random pose or, equally often, arbitrary bits, which a circuit must
// treat alike.
PairRegisters GoldenVectors::random_registers() {
  if (below(2) == 0) {
    double q[4], length2 = 0;
    do {
      length2 = 0;
      for (double& x : q) {
        x = between(-1, 1);
        length2 += x * x;
      }
    } while (!(length2 > 0.01 && length2 < 1));
    // One draw a statement: a compiler may evaluate the two sides of a product in either order.
    const double eighths = static_cast<double>(1u << below(6));
    const double ratio = between(1, 1.99) * eighths / 8;
    const auto pad = static_cast<std::uint16_t>(4 + below(4));
    return make_registers(rotation_of(q[0], q[1], q[2], q[3]), ratio, pad);
  }
  PairRegisters registers;
  for (std::int32_t& entry : registers.rotation) {
    entry = static_cast<std::int32_t>(below(1u << 20)) - (1 << 19);
  }
  for (std::uint16_t& radius : registers.radius) {
    radius = static_cast<std::uint16_t>(below(1 << 16));
  }
  registers.pad = static_cast<std::uint16_t>(below(1 << 16));
  return registers;
}

GoldenVector GoldenVectors::random_vector(bool near) {
  while (true) {
    GoldenVector vector;
    vector.registers = random_registers();
    NodePair& pair = vector.pair;
    pair.fixed_level = static_cast<std::uint8_t>(below(kMaxNodeLevel + 1));
    pair.moving_level = static_cast<std::uint8_t>(below(kMaxNodeLevel + 1));
    pair.fixed_mask = static_cast<std::uint8_t>(below(256));
    pair.moving_mask = static_cast<std::uint8_t>(below(256));
    for (std::int32_t& x : pair.fixed_centre) {
      x = static_cast<std::int32_t>(below(2 * kMaxCentre + 1)) - kMaxCentre;
    }
    const auto reach = static_cast<double>(test_pair(pair, vector.registers).reach);
    double way[3], length2 = 0;
    for (double& x : way) {
      x = between(-1, 1);
      length2 += x * x;
    }
    double scale = reach;
    if (near) {  // down to a relative distance at which only the last bits decide
      const double narrow = static_cast<double>(1u << below(18));
      scale *= (1 + between(-1, 1) / narrow) / std::sqrt(length2);
    }
    const auto along = [&](int i) { return static_cast<std::int64_t>(scale * way[i]); };
    const std::optional<GoldenVector> placed = at_distance(vector, {along(0), along(1), along(2)});
    if (placed) return *placed;
  }
}

}  // namespace ist
