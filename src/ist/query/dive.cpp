#include "ist/query/dive.h"

#include <limits>
#include <utility>

namespace ist {
namespace {

struct Near {
  std::uint32_t fixed, moving;
  float farthest;
};

// The nearest pairs seen, in order.
class Nearest {
 public:
  void add(const Near& pair) {
    if (count_ == Dive::kWidth && !(pair.farthest < pairs_[count_ - 1].farthest)) return;
    count_ += count_ < Dive::kWidth ? 1U : 0U;
    std::size_t at = count_ - 1;
    for (; at > 0 && pair.farthest < pairs_[at - 1].farthest; --at) pairs_[at] = pairs_[at - 1];
    pairs_[at] = pair;
  }
  [[nodiscard]] std::span<const Near> pairs() const { return {pairs_, count_}; }

 private:
  Near pairs_[Dive::kWidth] = {};
  std::size_t count_ = 0;
};

}  // namespace

Dive dive(const SearchPlan& plan, const SearchPose& pose, SearchScratch& scratch) noexcept {
  Dive found;
  Nearest nearest;
  nearest.add({0, 0, std::numeric_limits<float>::infinity()});
  FixedLanes& a = scratch.fixed;
  MovingLanes& b = scratch.moving;
  FixedRows& rows = scratch.rows[0];
  for (const SearchStep& step : plan.steps()) {
    const Nearest opened = std::exchange(nearest, {});
    for (const Near& pair : opened.pairs()) {
      const std::uint32_t of_a = decode(step.fixed, pair.fixed, a, 0);
      const std::uint32_t of_b = decode(step.moving, pair.moving, b, 0);
      for (std::uint32_t i = 0; i < of_a; ++i) {
        turn(pose, false, a, i, rows);
        for (std::uint32_t j = 0; j < of_b; ++j) {
          Measure measured;
          static_cast<void>(measure(rows, i, b, j, false, measured));
          nearest.add({a.name[i], b.name[j], measured.farthest});
        }
      }
      found.tests += of_a * of_b;
    }
  }
  for (const Near& pair : nearest.pairs()) {
    found.leaves[found.count++] = {pair.fixed, pair.moving};
  }
  plan.resolve({found.leaves, found.count});
  found.farthest = nearest.pairs().front().farthest;
  return found;
}

}  // namespace ist
