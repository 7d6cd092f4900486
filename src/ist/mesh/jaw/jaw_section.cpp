#include "ist/mesh/jaw/jaw_section.h"

#include <array>

#include "ist/mesh/jaw/jaw_spline.h"

namespace ist {

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
