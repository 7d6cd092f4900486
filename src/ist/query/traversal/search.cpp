#include "ist/query/traversal/search.h"

#include <algorithm>
#include <limits>

#include "ist/base/assert.h"
#include "ist/query/traversal/search_pose.h"

namespace ist {
namespace {

// A beam goes down from at most this number of pairs.
constexpr std::size_t kBeamPairs = 16;

// A beam is made no narrower than this part of the widest one. If it still holds too many pairs,
// it leaves some of them out.
constexpr float kLeastWidth = 0x1p-6F;

// Returns the most pairs before step `i`, or leaf pairs, that fit the memory.
std::size_t capacity_of(const SearchPlan::Sizes& sizes, std::size_t i, std::size_t pairs) noexcept {
  const std::size_t most = i == 0 ? 1 : sizes.steps[i - 1].pairs;
  const std::size_t row = i == 0 ? 1 : sizes.steps[i - 1].row;
  return std::max(row, std::min({pairs, most, std::size_t{1} << 31}));
}

}  // namespace

Search::Search(const SearchPlan& plan, const Kernels& kernels, std::size_t pairs, std::size_t items)
    : plan_(plan),
      kernels_(kernels),
      most_pairs_(pairs),
      groups_(std::max(items, items_for(plan.sizes(), pairs))),
      moving_(groups_.size()),
      scratch_(std::make_unique<SearchScratch>()) {
  frontiers_.reserve(SearchPlan::kMostSteps + 1);
  bind();
  // Makes the first dispatched calls. With infinite pads all bounds overlap, wherever the bodies
  // lie.
  SearchPose pose{};
  constexpr float kAll = std::numeric_limits<float>::infinity();
  pose.leaf = pose.inner = {kAll, kAll, kAll};
  BudgetMeter unlimited;
  static_cast<void>(beam(pose, unlimited));
}

void Search::bind() noexcept {
  frontiers_.clear();
  std::size_t first = 0;
  for (std::size_t i = 0; i <= plan_.sizes().count; ++i) {
    const std::size_t capacity = capacity_of(plan_.sizes(), i, most_pairs_);
    frontiers_.push_back({groups_.data() + first, moving_.data() + first, 0, 0, capacity});
    first += capacity + kFrontierSpare;
  }
  IST_ASSERT(first <= groups_.size());
  Frontier& roots = frontiers_.front();
  roots.groups[0] = {0, 1};
  roots.moving[0] = 0;
  roots.group_count = roots.moving_count = 1;
}

std::size_t Search::items_for(const SearchPlan::Sizes& sizes, std::size_t pairs) noexcept {
  std::size_t items = 0;
  for (std::size_t i = 0; i <= sizes.count; ++i) {
    items += capacity_of(sizes, i, pairs) + kFrontierSpare;
  }
  return items;
}

std::size_t Search::whole_steps(const SearchPosition& at, std::size_t most) const noexcept {
  std::size_t step = at.first_step;
  while (step < most && at.cursors[step].group == pairs_before(step, at).group_count) ++step;
  return step;
}

float Search::beam(const SearchPose& pose, BudgetMeter& meter) noexcept {
  float upper = DistanceBounds::kNone;
  Frontier in = frontiers_.front();
  for (std::size_t i = 0; i < plan_.steps().size(); ++i) {
    SearchStep step = plan_.steps()[i];
    step.last = true;  // so that every pair is measured
    Frontier& out = frontiers_[i + 1];
    // Returns whether the budget was enough.
    const auto test = [&](const SearchPose& with, DistanceBounds& bounds) {
      SearchCursor cursor;
      out.group_count = out.moving_count = 0;
      const SearchBatch batch{kernels_, step, in, cursor, out, *scratch_};
      Advanced made;
      do {
        made = batch.measure(Measured::kBoth, with, bounds, meter.allow());
        meter.spend(made.tests);
      } while (made.tests > 0 && !made.full && cursor.group < in.group_count);
      return made.full || cursor.group >= in.group_count;
    };
    DistanceBounds all;
    bool enough = test(pose, all);
    upper = std::min(upper, all.upper);
    const float widest = 0.125F * step.radius_limit;
    for (float width = widest; enough; width *= 0.5F) {
      DistanceBounds none;
      enough = test(inflated(pose, all.lower + width), none);
      if (out.moving_count <= kBeamPairs || width < kLeastWidth * widest) break;
    }
    if (!enough) break;
    in = out;
    // A frontier that begins with more pairs ends with the first of them.
    in.moving_count = std::min(in.moving_count, kBeamPairs);
    while (in.group_count > 1 && in.groups[in.group_count - 2].end >= in.moving_count) {
      --in.group_count;
    }
    if (in.group_count > 0) {
      in.groups[in.group_count - 1].end = static_cast<std::uint32_t>(in.moving_count);
    }
  }
  return upper;
}

std::size_t Search::bytes_for(const SearchPlan& plan, std::size_t pairs,
                              std::size_t items) noexcept {
  return sizeof(SearchScratch) + std::max(items, items_for(plan.sizes(), pairs)) *
                                     (sizeof(SearchGroup) + sizeof(std::uint32_t));
}

}  // namespace ist
