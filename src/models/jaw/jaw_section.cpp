#include "models/jaw/jaw_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "models/jaw/jaw_spline.h"

namespace ist {
namespace {

constexpr std::ptrdiff_t kSpans = 9, kStepsPerSpan = 64;

// Incisors, canine, premolars, molars, then the ramus to the condyle; mm.
constexpr double kControls[][2] = {{0, -46.5},    {9, -44.5},   {16.2, -37.5}, {20.5, -27.5},
                                   {23.5, -16.5}, {27.5, -5.5}, {34, 5},       {41, 15},
                                   {46.5, 25.5},  {51, 36},     {55.5, 46.5}};
static_assert(std::size(kControls) == kSpans + 2);

Eigen::Vector2d control(std::ptrdiff_t i) {
  const auto& c = kControls[std::abs(i)];
  return {i < 0 ? -c[0] : c[0], c[1]};
}

// Returns point and derivative at a parameter in [0, kSpans].
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

std::vector<Station> lay_out_stations(std::span<const Tooth> row, std::size_t behind,
                                      double length) {
  std::vector<Station> stations{{0, 0, -1, 0}};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int count = row[i].shape.stations;
    for (int k = 1; k <= count; ++k) {
      const double u = 2.0 * k / count - 1;
      const double place = u * (5 - u * u) / 4;
      const double part = (place + 1) / 2;
      stations.push_back({row[i].begin + part * (row[i].end - row[i].begin), i, place, 0});
    }
  }
  const double end = row.back().end;
  for (std::size_t k = 1; k <= behind; ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(behind);
    const double part = u * (1.5 - 0.5 * u * u);
    stations.push_back({end + part * (length - end), row.size() - 1, 1, part});
  }
  return stations;
}

double unevenness(std::uint64_t bone_seed, std::size_t line, double distance) {
  constexpr double kStep = 6, kReach = 120;
  const double position = (distance + kReach) / kStep;
  const auto first = static_cast<std::size_t>(position);
  const std::array<double, 4> w = spline_weights(position - static_cast<double>(first));
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    sum += w[k] * random_signed(bone_seed, 4096 + 64 * line + first + k);
  }
  return sum;
}

}  // namespace ist
