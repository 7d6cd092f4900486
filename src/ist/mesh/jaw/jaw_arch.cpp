#include "ist/mesh/jaw/jaw_arch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ist/mesh/jaw/jaw_spline.h"

namespace ist {
namespace {

constexpr std::ptrdiff_t kSpans = 9, kStepsPerSpan = 64;

// Incisors, canine, premolars, molars, then the ramus to the condyle; mm.
constexpr std::array<std::array<double, 2>, kSpans + 2> kControls{{{0, -46.5},
                                                                   {9, -44.5},
                                                                   {16.2, -37.5},
                                                                   {20.5, -27.5},
                                                                   {23.5, -16.5},
                                                                   {27.5, -5.5},
                                                                   {34, 5},
                                                                   {41, 15},
                                                                   {46.5, 25.5},
                                                                   {51, 36},
                                                                   {55.5, 46.5}}};

Eigen::Vector2d control(std::ptrdiff_t i) {
  const auto& c = kControls[static_cast<std::size_t>(i < 0 ? -i : i)];
  return {i < 0 ? -c[0] : c[0], c[1]};
}

// Point and derivative at a parameter in [0, kSpans].
std::array<Eigen::Vector2d, 2> evaluate(double parameter) {
  const std::ptrdiff_t i = std::min(static_cast<std::ptrdiff_t>(parameter), kSpans - 1);
  const double u = parameter - static_cast<double>(i), v = 1 - u;
  const std::array<double, 4> w = spline_weights(u);
  const std::array<double, 4> slope{-v * v / 2, (3 * u * u - 4 * u) / 2, (4 * v - 3 * v * v) / 2,
                                    u * u / 2};
  std::array<Eigen::Vector2d, 2> result{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    result[0] += w[static_cast<std::size_t>(k)] * control(i + k - 1);
    result[1] += slope[static_cast<std::size_t>(k)] * control(i + k - 1);
  }
  return result;
}

double length(const Eigen::Vector2d& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y()); }

}  // namespace

Arch::Arch() {
  lengths_.push_back(0);
  Eigen::Vector2d last = evaluate(0)[0];
  for (std::ptrdiff_t step = 1; step <= kSpans * kStepsPerSpan; ++step) {
    const Eigen::Vector2d next = evaluate(static_cast<double>(step) / kStepsPerSpan)[0];
    lengths_.push_back(lengths_.back() + length(next - last));
    last = next;
  }
}

ArchFrame Arch::at(double distance) const {
  const double along = std::clamp(distance, 0.0, lengths_.back());
  const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, along);
  const double part = (along - after[-1]) / (after[0] - after[-1]);
  const double steps = static_cast<double>(after - lengths_.begin() - 1) + part;
  const auto [point, tangent] = evaluate(steps / kStepsPerSpan);
  return {point, Eigen::Vector2d(tangent.y(), -tangent.x()) / length(tangent)};
}

}  // namespace ist
