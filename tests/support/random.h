#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <random>
#include <type_traits>

namespace ist::test {

/// Numbers from a seed, the same with every standard library: no std distribution, whose values are
/// the library's own choice.
class Random {
 public:
  /// `bits`: those of each number that `uniform` draws, at most 53.
  explicit Random(std::uint64_t seed, int bits = 53) : engine_(seed), unused_bits_(64 - bits) {}

  std::uint64_t bits() { return engine_(); }
  /// A whole number below `end`, which is above 0.
  template <std::integral Integer>
  std::make_unsigned_t<Integer> below(Integer end) {
    return static_cast<std::make_unsigned_t<Integer>>(engine_() % static_cast<std::uint64_t>(end));
  }
  /// A number from `low` to `high`, where it is rounded.
  double uniform(double low, double high) {
    const auto drawn = static_cast<double>(engine_() >> unused_bits_);
    return low + (high - low) * std::ldexp(drawn, unused_bits_ - 64);
  }
  /// A point of the cube [low, high]³.
  Eigen::Vector3d point(double low, double high);
  /// A point of the cube whose coordinates are multiples of `step`, a power of two.
  Eigen::Vector3d point_on_grid(double low, double high, double step);
  /// A unit vector, all directions alike.
  Eigen::Vector3d direction();
  /// A rotation, orthonormal to within rounding.
  Eigen::Matrix3d rotation();

 private:
  std::mt19937_64 engine_;
  int unused_bits_;
};

}  // namespace ist::test
