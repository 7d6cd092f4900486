#include "ist/query/dive.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ist {
namespace {

struct Near {
  std::uint32_t fixed, moving;
  float apart;
};

// The nearest pairs added so far, sorted by distance.
class Nearest {
 public:
  void add(const Near& pair) {
    if (count_ == Dive::kWidth && !(pair.apart < pairs_[count_ - 1].apart)) return;
    count_ += count_ < Dive::kWidth ? 1U : 0U;
    std::size_t at = count_ - 1;
    for (; at > 0 && pair.apart < pairs_[at - 1].apart; --at) pairs_[at] = pairs_[at - 1];
    pairs_[at] = pair;
  }
  [[nodiscard]] std::span<const Near> pairs() const { return {pairs_, count_}; }

 private:
  Near pairs_[Dive::kWidth] = {};
  std::size_t count_ = 0;
};

using Eight = Eigen::Array<float, 8, 1>;

// The signed distance between the bounds of a row and of each of eight moving nodes, as measure()
// defines it, and the upper bound of the distance between their points; mesh units.
struct Distances {
  Eight apart, farthest;
};
Distances measure_eight(const FixedRows& f, std::size_t row, const MovingLanes& m, bool slabs) {
  const auto lane = [&](Lane number) { return Eigen::Map<const Eight>(m.lane[number]); };
  const Eight dx = lane(kX) - f.x[row], dy = lane(kY) - f.y[row], dz = lane(kZ) - f.z[row];
  // Square roots are taken one by one: Eigen estimates those of an array, with bits that depend on
  // the processor.
  const Eight distance =
      ((dx * dx + dy * dy) + dz * dz).unaryExpr([](float x) { return std::sqrt(x); });
  const Eight reach = lane(kRadius) + f.radius[row];
  Distances distances{distance - reach, distance + reach};
  if (!slabs) return distances;
  const Eight above_fixed =
      ((dx * f.normal_x[row] + dy * f.normal_y[row]) + dz * f.normal_z[row]) - f.offset[row];
  const Eight above_moving =
      ((dx * lane(kNormalX) + dy * lane(kNormalY)) + dz * lane(kNormalZ)) + lane(kOffset);
  const Eight high = above_fixed.abs() - (lane(kRadius) + f.half[row]);
  const Eight over = (above_moving.abs() - (lane(kHalf) + f.scaled_radius[row])) * (1 / kSlabScale);
  distances.apart = distances.apart.max(high).max(over);
  return distances;
}

}  // namespace

Dive dive(const SearchPlan& plan, const Kernels& kernels, const SearchPose& pose,
          SearchScratch& scratch) noexcept {
  Dive found;
  Nearest nearest;
  nearest.add({0, 0, 0});
  float farthest = std::numeric_limits<float>::infinity();
  FixedRows& rows = scratch.rows[0];
  for (const SearchStep& step : plan.steps()) {
    const bool slabs = step.fixed.slabs != nullptr;
    const Nearest opened = std::exchange(nearest, {});
    for (const Near& pair : opened.pairs()) {
      const std::uint32_t of_a = decode(step.fixed, pair.fixed, scratch.fixed, 0);
      const std::uint32_t of_b = kernels.parts.decode(step.moving, pair.moving, scratch.moving, 0);
      kernels.parts.turn(pose, slabs, scratch.fixed, rows);
      for (std::uint32_t i = 0; i < of_a; ++i) {
        const Distances distances = measure_eight(rows, i, scratch.moving, slabs);
        for (std::uint32_t j = 0; j < of_b; ++j) {
          const auto at = static_cast<Eigen::Index>(j);
          farthest = std::min(farthest, distances.farthest[at]);
          nearest.add({scratch.fixed.id[i], scratch.moving.id[j], distances.apart[at]});
        }
      }
      found.tests += of_a * of_b;
    }
  }
  for (const Near& pair : nearest.pairs()) {
    found.leaves[found.count++] = {pair.fixed, pair.moving};
  }
  plan.resolve({found.leaves, found.count});
  found.farthest = farthest;
  return found;
}

}  // namespace ist
