#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ist {

/// Returns the weights of four neighbouring control values of a uniform cubic B-spline, at `u` in
/// [0, 1] between the second and the third. The curve is twice differentiable and stays in the
/// convex hull of its controls.
inline std::array<double, 4> spline_weights(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
          u * u * u / 6};
}

/// Evaluates a spline over [0, n - 1]: mirrored at 0, where the halves of a jaw meet, and held
/// constant at the other end.
///
/// @param controls n >= 2 values at the positions 0, 1, 2, …
/// @param position clamped to the range
inline double spline(std::span<const double> controls, double position) {
  const auto last = static_cast<std::ptrdiff_t>(controls.size()) - 1;
  const double x = std::clamp(position, 0.0, static_cast<double>(last));
  const std::ptrdiff_t i = std::min(static_cast<std::ptrdiff_t>(x), last - 1);
  const std::array<double, 4> w = spline_weights(x - static_cast<double>(i));
  double sum = 0;
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    const std::ptrdiff_t j = i + k - 1;
    const std::ptrdiff_t held = j < 0 ? -j : std::min(j, last);
    sum += w[static_cast<std::size_t>(k)] * controls[static_cast<std::size_t>(held)];
  }
  return sum;
}

/// Rises from 0 at x <= 0 to 1 at x >= 1 with level ends.
inline double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Falls from 1 at 0 to 0 at -1 and 1, and stays 0 beyond.
inline double bump(double x) {
  const double t = std::clamp(1 - x * x, 0.0, 1.0);
  return t * t;
}

/// Returns a pseudorandom number in [-1, 1) that depends only on seed and key. Each variation has
/// its own key, so a new variation leaves the others as they were.
/// Source: splitmix64, S. Vigna.
inline double random_signed(std::uint64_t seed, std::uint64_t key) {
  std::uint64_t z = seed + (key + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  z ^= z >> 31;
  constexpr double kUnit = 1.0 / (std::uint64_t{1} << 52);
  return static_cast<double>(z >> 11) * kUnit - 1;
}

}  // namespace ist
