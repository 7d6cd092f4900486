#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

namespace ist::test {

/// Numbers that look random and are the same everywhere: no std distribution, whose values are the
/// standard library's own choice.
class Seeded {
 public:
  explicit Seeded(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t bits() { return bits_(); }
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(bits_() % end); }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  /// A point of the cube [low, high]³.
  Eigen::Vector3d point(double low, double high) {
    const double x = between(low, high), y = between(low, high), z = between(low, high);
    return {x, y, z};
  }
  /// A point of the cube whose coordinates are multiples of `step`, a power of two.
  Eigen::Vector3d point_on_grid(double low, double high, double step) {
    const auto snap = [step](double x) { return std::floor(x / step) * step; };
    const Eigen::Vector3d p = point(low, high);
    return {snap(p[0]), snap(p[1]), snap(p[2])};
  }
  /// A unit vector, all directions alike.
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d p = point(-1, 1);
      const double length2 = p.squaredNorm();
      if (length2 > 0.01 && length2 < 1) return p / std::sqrt(length2);
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace ist::test
