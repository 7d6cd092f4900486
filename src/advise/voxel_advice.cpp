#include "advise/voxel_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/base/platform/from_chars.h"
#include "ist/voxel/lattice.h"

namespace ist {
namespace {

// Logarithms of factors. No query result depends on this search, so libm may be used.
const double kLeastStep = std::log(1.12), kMostStep = std::log(3.0);
const double kClose = std::log(1.15), kCloseToUnfit = std::log(1.5);
const double kGoodEnough = std::log(0.9);
// Bounds of a power law's assumed exponent, and of the logarithm of value / limit.
constexpr double kFlattest = 0.25, kSteepest = 4, kFarthest = 10;
// The least distance of a new size from either of two measured ones, as a fraction of theirs.
constexpr double kNearest = 0.2;
constexpr std::size_t kMostSizes = 40;

// A measured size, in logarithms: the value is close to a power law of the size.
struct Tried {
  double at;      // log of the size, its sign such that it grows from safe sizes to failing ones
  double excess;  // log of value / limit: above 0 the goal is missed
};

class SizeSearch {
 public:
  SizeSearch(const AdviceGoal& goal, const SizeRange& range, const MeasureSize& measure)
      : goal_(goal),
        range_{round_to_two_digits(range.finest, true), range.first,
               round_to_two_digits(range.coarsest, false)},
        measure_(measure) {
    IST_ASSERT(range_.finest <= range_.coarsest);
  }

  VoxelAdvice run() {
    for (std::size_t tries = 0; tries < kMostSizes; ++tries) {
      const std::optional<double> size = unseen(next());
      if (!size) break;
      note(*size, measure_(*size));
    }
    std::sort(advice_.measured.begin(), advice_.measured.end(),
              [](const auto& a, const auto& b) { return a.voxel_size > b.voxel_size; });
    const auto best =
        std::find_if(advice_.measured.begin(), advice_.measured.end(),
                     [&](const SizeMeasure& measure) { return measure.voxel_size == best_; });
    if (best != advice_.measured.end()) advice_.recommended = best - advice_.measured.begin();
    return std::move(advice_);
  }

 private:
  [[nodiscard]] bool coarse_is_safe() const { return goal_.of == AdviceGoal::Of::kSlowestQuery; }
  [[nodiscard]] double at(double size) const {
    return coarse_is_safe() ? -std::log(size) : std::log(size);
  }
  // Returns the size at `at`, rounded towards meeting the goal (away from it if not `safe`) and
  // clamped to the range.
  [[nodiscard]] double size_at(double at, bool safe = true) const {
    const double size = std::exp(coarse_is_safe() ? -at : at);
    return std::clamp(round_to_two_digits(size, coarse_is_safe() == safe), range_.finest,
                      range_.coarsest);
  }

  void note(double size, const std::optional<SizeMeasure>& measure) {
    tried_.push_back(size);
    if (!measure) {
      advice_.too_fine = std::max(size, advice_.too_fine.value_or(size));
      if (coarse_is_safe()) fails_ = Tried{at(size), kFarthest};
      return;
    }
    advice_.measured.push_back(*measure);
    const double excess =
        std::clamp(std::log(goal_.value(*measure) / goal_.limit), -kFarthest, kFarthest);
    const Tried tried{at(size), excess};
    if (last_) {
      const double slope = (tried.excess - last_->excess) / (tried.at - last_->at);
      slope_ = slope >= kFlattest ? std::min(slope, kSteepest) : kFlattest;
    }
    last_ = tried;
    if (goal_.holds(*measure)) {
      holds_ = tried;
      best_ = size;
    } else {
      fails_ = tried;
    }
  }

  // Returns where to measure next, or nothing if the search is done.
  [[nodiscard]] std::optional<double> next() const {
    if (!holds_ && !fails_) {
      if (!advice_.too_fine) return at(range_.first);
      return at(*advice_.too_fine) + kMostStep;  // for errors, which grow with the size
    }
    if (holds_ && holds_->excess >= kGoodEnough) return std::nullopt;
    if (!fails_) return holds_->at + step(-holds_->excess);
    if (!holds_) return towards_safety();
    const double width = fails_->at - holds_->at;
    const bool is_unfit = advice_.too_fine && at(*advice_.too_fine) == fails_->at;
    if (width <= (is_unfit ? kCloseToUnfit : kClose)) return std::nullopt;
    const double part = is_unfit ? 0.5 : holds_->excess / (holds_->excess - fails_->excess);
    return holds_->at + width * std::clamp(part, kNearest, 1 - kNearest);
  }

  [[nodiscard]] std::optional<double> towards_safety() const {
    const double to = fails_->at - step(fails_->excess);
    if (coarse_is_safe() || !advice_.too_fine || to > at(*advice_.too_fine)) return to;
    const double room = fails_->at - at(*advice_.too_fine);
    if (room <= kCloseToUnfit) return std::nullopt;
    return fails_->at - room / 2;
  }

  // Returns the step that should change the excess by `excess`, clamped to the limits of a step.
  [[nodiscard]] double step(double excess) const {
    return std::clamp(excess / slope_, kLeastStep, kMostStep);
  }

  // Returns the size at `at` if it is new, else its rounding to the other side if that is new.
  [[nodiscard]] std::optional<double> unseen(std::optional<double> at) const {
    if (!at) return std::nullopt;
    for (const bool safe : {true, false}) {
      const double size = size_at(*at, safe);
      if (std::find(tried_.begin(), tried_.end(), size) == tried_.end()) return size;
    }
    return std::nullopt;
  }

  AdviceGoal goal_;
  SizeRange range_;
  const MeasureSize& measure_;
  VoxelAdvice advice_;
  std::vector<double> tried_;
  std::optional<Tried> last_, holds_, fails_;  // holds_ and fails_ bracket the goal
  double slope_ = 1;
  double best_ = 0;
};

double number(const std::string& text) {  // unlike std::stod, independent of the locale
  double value = 0;
  from_chars(text, value);
  return value;
}

}  // namespace

double round_to_two_digits(double size, bool up) {
  const ScopedFloatEnvironment environment;
  // 15 digits reproduce any decimal that was read from fewer.
  const std::string text = fmt::format("{:.14e}", size);
  const int digits = 10 * (text[0] - '0') + (text[2] - '0');
  const int exponent = static_cast<int>(number(text.substr(text.find('e') + 2))) *
                       (text[text.find('e') + 1] == '-' ? -1 : 1);
  const bool is_rounder = text.find_first_not_of('0', 3) == text.find('e');
  return number(fmt::format("{}e{}", up && !is_rounder ? digits + 1 : digits, exponent - 1));
}

std::optional<SizeRange> sizes_between(double fixed_extent, double moving_extent) {
  constexpr double kFirst = 1.0 / 50, kCoarsest = 1.0 / 5;
  const auto [smaller, larger] = std::minmax(fixed_extent, moving_extent);
  SizeRange range{larger / Lattice::kMaxCells, kFirst * larger, kCoarsest * larger};
  range.coarsest = std::min(range.coarsest, 0.5 * Lattice::kMaxRelativeSize * smaller);
  range.first = std::min(range.first, range.coarsest);
  if (!(2 * range.finest < range.first)) return std::nullopt;
  return range;
}

VoxelAdvice advise_voxel_size(const AdviceGoal& goal, const SizeRange& range,
                              const MeasureSize& measure) {
  const ScopedFloatEnvironment environment;
  IST_ASSERT(goal.limit > 0 && range.finest > 0);
  IST_ASSERT(range.finest <= range.first && range.first <= range.coarsest);
  return SizeSearch(goal, range, measure).run();
}

}  // namespace ist
