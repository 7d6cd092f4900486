#pragma once

#include <cmath>
#include <numbers>

/// Angles by + - × ÷ and square roots alone: the bits of libm's functions depend on the processor.
namespace ist {

/// Returns the angle, in [0, pi], whose tangent is y / x, for y >= 0: to within 1e-13. Halves the
/// angle until a series of a few terms suffices.
[[nodiscard]] inline double angle_of(double y, double x) noexcept {
  if (x < 0) return std::numbers::pi - angle_of(y, -x);
  const double length = std::sqrt(y * y + x * x);
  if (!(length > 0)) return 0;
  double tangent = y / (length + x);  // of a half
  for (int halving = 0; halving < 2; ++halving) {
    tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
  }
  const double square = tangent * tangent;  // of an eighth: at most 0.04
  double series = 0;
  for (int term = 17; term >= 1; term -= 2) {
    series = (term % 4 == 1 ? 1.0 : -1.0) / term + square * series;
  }
  return 8 * tangent * series;
}

struct SineCosine {
  double sine, cosine;
};

/// Returns the sine and the cosine of an angle, to within 1e-15 of the angle or of 1, whichever is
/// larger.
[[nodiscard]] inline SineCosine sine_cosine(double angle) noexcept {
  int doublings = 0;
  for (; std::abs(angle) > 0.125 && doublings < 1100; ++doublings) angle *= 0.5;
  const double square = angle * angle;
  double sine = 0, versine = 0;  // series of sine / angle, and of (1 - cosine) / (square / 2)
  for (int term = 12; term >= 2; term -= 2) {
    sine = 1 - square / (term * (term + 1)) * (term == 12 ? 1.0 : sine);
    versine = 1 - square / ((term + 1) * (term + 2)) * (term == 12 ? 1.0 : versine);
  }
  double s = angle * sine, v = 0.5 * square * versine;  // v: 1 - cosine
  for (; doublings > 0; --doublings) {
    const double twice = 2 * s * (1 - v);
    v = 2 * s * s;
    s = twice;
  }
  const double c = 1 - v, length = std::sqrt(s * s + c * c);
  return {s / length, c / length};
}

}  // namespace ist
