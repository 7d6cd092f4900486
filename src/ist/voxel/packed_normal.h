#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace ist {

/// A voxel's normal in 32 bits: 12 bits for each of two coordinates of the octahedral map, 8 bits
/// of coherence. The direction is right to 0.06 degrees and exact along the axes; mirroring a
/// normal mirrors its stored numbers.
///
/// Coherence is |sum of the area-weighted normals| / (sum of the areas): 1 on a flat patch, 0 where
/// both sides of a thin shell cancel. With coherence 0 the normal has no direction, and the whole
/// word is 0.
///
/// Source: Q. Meyer et al., On floating-point normal vectors, EGSR 2010.
class PackedNormal {
 public:
  PackedNormal() = default;

  /// Packs `sum`, of area-weighted unit normals, and `weight`, the sum of the areas, in any common
  /// unit.
  PackedNormal(const Eigen::Vector3d& sum, double weight) noexcept {
    const double length = std::sqrt((sum[0] * sum[0] + sum[1] * sum[1]) + sum[2] * sum[2]);
    const int coherence = weight > 0 ? round(255 * (length / weight)) : 0;
    if (!(coherence > 0)) return;
    const double scale = 1 / ((std::abs(sum[0]) + std::abs(sum[1])) + std::abs(sum[2]));
    double u = sum[0] * scale, v = sum[1] * scale;
    if (sum[2] < 0) fold(u, v);
    word_ = static_cast<std::uint32_t>(round(u * kHalf) + kHalf) << 20 |
            static_cast<std::uint32_t>(round(v * kHalf) + kHalf) << 8 |
            static_cast<std::uint32_t>(coherence > 255 ? 255 : coherence);
  }

  /// Unpacks a stored word. Every word is a valid normal, so no file can hold an invalid one.
  static PackedNormal from_word(std::uint32_t word) noexcept {
    PackedNormal normal;
    normal.word_ = word;
    return normal;
  }
  [[nodiscard]] std::uint32_t word() const noexcept { return word_; }

  /// The coherence, in [0, 1]; 0 means no direction.
  [[nodiscard]] double coherence() const noexcept { return (word_ & 255) / 255.0; }

  /// Returns the outward unit normal; zero if the coherence is 0.
  [[nodiscard]] Eigen::Vector3d direction() const noexcept {
    if ((word_ & 255) == 0) return Eigen::Vector3d::Zero();
    double u = (static_cast<int>(word_ >> 20) - kHalf) / double{kHalf};
    double v = (static_cast<int>(word_ >> 8 & 4095) - kHalf) / double{kHalf};
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z < 0) fold(u, v);
    const double length = std::sqrt((u * u + v * v) + z * z);
    return {u / length, v / length, z / length};
  }

 private:
  static constexpr int kHalf = 2047;
  // Folds the lower half over the diagonals, or back.
  static void fold(double& u, double& v) noexcept {
    const double folded_u = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
    v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
    u = folded_u;
  }
  static int round(double value) noexcept {  // half away from zero, for symmetry
    return static_cast<int>(value < 0 ? value - 0.5 : value + 0.5);
  }

  std::uint32_t word_ = 0;
};

static_assert(sizeof(PackedNormal) == 4);

}  // namespace ist
