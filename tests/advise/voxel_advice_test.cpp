#include "advise/voxel_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/effort.h"

namespace ist::test {
namespace {

constexpr SizeRange kRange{0.001, 2, 20};

using Curve = std::function<double(double)>;

// Measures made up of two curves; counts them, and sees that each is asked once and in range.
class Measures {
 public:
  Measures(Curve error, Curve tick, double finest_that_fits = 0)
      : error_(std::move(error)), tick_(std::move(tick)), finest_(finest_that_fits) {}

  VoxelAdvice advise(const AdviceGoal& goal, const SizeRange& range = kRange) {
    return advise_voxel_size(goal, range, [&](double size) -> std::optional<SizeMeasure> {
      EXPECT_EQ(std::count(asked_.begin(), asked_.end(), size), 0) << size;
      EXPECT_EQ(round_to_two_digits(size, true), size);
      EXPECT_GE(size, range.finest);
      EXPECT_LE(size, range.coarsest);
      asked_.push_back(size);
      if (size < finest_) return std::nullopt;
      SizeMeasure measure;
      measure.voxel_size = size;
      measure.error = error_(size);
      measure.slowest_query = tick_(size);
      return measure;
    });
  }
  [[nodiscard]] const std::vector<double>& asked() const { return asked_; }

 private:
  Curve error_, tick_;
  double finest_;
  std::vector<double> asked_;
};

Curve power(double factor, double exponent) {
  return [=](double size) { return factor * std::pow(size, exponent); };
}
Curve nothing() {
  return [](double) { return 0.0; };
}

// What is recommended holds the goal, and is not wasteful.
void expect_good(const VoxelAdvice& advice, const AdviceGoal& goal, const Curve& curve) {
  ASSERT_TRUE(advice.recommended);
  const SizeMeasure& best = advice.measured[*advice.recommended];
  EXPECT_LE(goal.value(best), goal.limit);
  EXPECT_EQ(goal.value(best), curve(best.voxel_size));
  const double next = goal.of == AdviceGoal::Of::kError ? 1.16 : 1 / 1.16;
  EXPECT_TRUE(goal.value(best) >= 0.9 * goal.limit || curve(next * best.voxel_size) > goal.limit)
      << best.voxel_size;
  for (std::size_t i = 1; i < advice.measured.size(); ++i) {
    EXPECT_GT(advice.measured[i - 1].voxel_size, advice.measured[i].voxel_size);
  }
}

TEST(VoxelAdvice, RoundsToTwoDigits) {
  EXPECT_EQ(round_to_two_digits(0.3, true), 0.3);
  EXPECT_EQ(round_to_two_digits(0.3, false), 0.3);
  EXPECT_EQ(round_to_two_digits(0.301, true), 0.31);
  EXPECT_EQ(round_to_two_digits(0.309, false), 0.3);
  EXPECT_EQ(round_to_two_digits(9.96, true), 10);
  EXPECT_EQ(round_to_two_digits(9.96, false), 9.9);
  EXPECT_EQ(round_to_two_digits(1234, true), 1300);
  EXPECT_EQ(round_to_two_digits(1.234e-7, false), 1.2e-7);
  EXPECT_EQ(round_to_two_digits(1e15, true), 1e15);
}

TEST(VoxelAdvice, PowerLaws) {
  for (const double limit : {0.015, 0.037, 0.2, 0.8, 3.0}) {
    for (const double exponent : {0.6, 1.0, 1.7}) {
      SCOPED_TRACE(std::to_string(limit) + " ^ " + std::to_string(exponent));
      const Curve curve = power(0.7, exponent);
      Measures measures(curve, nothing());
      const AdviceGoal goal{AdviceGoal::Of::kError, limit};
      expect_good(measures.advise(goal), goal, curve);
      EXPECT_LE(measures.asked().size(), 10u);
    }
  }
  for (const double limit : {5.0, 60.0, 300.0, 5000.0}) {
    for (const double exponent : {-0.8, -1.2, -2.0}) {
      SCOPED_TRACE(std::to_string(limit) + " ^ " + std::to_string(exponent));
      const Curve curve = power(40, exponent);
      Measures measures(nothing(), curve);
      const AdviceGoal goal{AdviceGoal::Of::kSlowestQuery, limit};
      expect_good(measures.advise(goal), goal, curve);
      EXPECT_LE(measures.asked().size(), 10u);
    }
  }
}

// The times are off by a fifth, and the error goes up and down. The recommended size was measured
// to hold the goal. It is near the size at which the curve without noise meets the limit.
TEST(VoxelAdvice, NoiseAndWiggles) {
  for (int seed = 1; seed <= samples(200); ++seed) {
    SCOPED_TRACE(seed);
    const auto noisy = [=](const Curve& curve) {
      return [=](double size) { return curve(size) * (1 + 0.2 * std::sin(1e3 * seed * size)); };
    };
    const Curve tick = noisy(power(40, -1.3)), error = noisy(power(0.6, 1));
    Measures measures(error, tick);
    const VoxelAdvice timed = measures.advise({AdviceGoal::Of::kSlowestQuery, 250});
    ASSERT_TRUE(timed.recommended);
    const SizeMeasure& best = timed.measured[*timed.recommended];
    EXPECT_LE(best.slowest_query, 250);
    EXPECT_EQ(best.slowest_query, tick(best.voxel_size));
    EXPECT_NEAR(std::log(best.voxel_size / std::pow(250 / 40.0, 1 / -1.3)), 0, std::log(1.5));

    Measures again(error, tick);
    const VoxelAdvice exact = again.advise({AdviceGoal::Of::kError, 0.1});
    ASSERT_TRUE(exact.recommended);
    const SizeMeasure& coarsest = exact.measured[*exact.recommended];
    EXPECT_LE(coarsest.error, 0.1);
    EXPECT_EQ(coarsest.error, error(coarsest.voxel_size));
    EXPECT_NEAR(std::log(coarsest.voxel_size / (0.1 / 0.6)), 0, std::log(1.6));
    EXPECT_LE(std::max(measures.asked().size(), again.asked().size()), 14u);
  }
}

// Errors that are 0 below a size, as of poses where voxels then say nothing false.
TEST(VoxelAdvice, AStep) {
  const Curve step = [](double size) { return size < 0.31 ? 0.0 : 0.5; };
  Measures measures(step, nothing());
  const AdviceGoal goal{AdviceGoal::Of::kError, 0.1};
  expect_good(measures.advise(goal), goal, step);
}

TEST(VoxelAdvice, NeverReached) {
  Measures slow(nothing(), [](double) { return 100.0; });
  const VoxelAdvice timed = slow.advise({AdviceGoal::Of::kSlowestQuery, 99});
  EXPECT_FALSE(timed.recommended);
  EXPECT_EQ(timed.measured.front().voxel_size, kRange.coarsest);  // it was tried

  Measures coarse([](double) { return 0.5; }, nothing());
  const VoxelAdvice exact = coarse.advise({AdviceGoal::Of::kError, 0.4});
  EXPECT_FALSE(exact.recommended);
  EXPECT_EQ(exact.measured.back().voxel_size, kRange.finest);
}

TEST(VoxelAdvice, HoldsEverywhere) {
  Measures fast(nothing(), power(1e-3, -1));
  const VoxelAdvice timed = fast.advise({AdviceGoal::Of::kSlowestQuery, 99});
  ASSERT_TRUE(timed.recommended);
  EXPECT_EQ(timed.measured[*timed.recommended].voxel_size, kRange.finest);
  Measures good(power(1e-3, 1), nothing());
  const VoxelAdvice exact = good.advise({AdviceGoal::Of::kError, 99});
  ASSERT_TRUE(exact.recommended);
  EXPECT_EQ(exact.measured[*exact.recommended].voxel_size, kRange.coarsest);
}

// Sizes that cannot be built: of times the finest that can, nearly; of errors none, where it is
// finer than those; and where even the first cannot, coarser ones are tried.
TEST(VoxelAdvice, SizesThatDoNotFit) {
  constexpr double kFits = 0.15;
  const Curve tick = power(40, -1), error = power(0.6, 1);
  Measures timed(error, tick, kFits);
  const VoxelAdvice finest = timed.advise({AdviceGoal::Of::kSlowestQuery, 1e4});
  ASSERT_TRUE(finest.recommended);
  EXPECT_LE(finest.measured[*finest.recommended].voxel_size, 1.5 * kFits);
  ASSERT_TRUE(finest.too_fine);
  EXPECT_LT(*finest.too_fine, kFits);

  Measures exact(error, tick, kFits);
  const VoxelAdvice none = exact.advise({AdviceGoal::Of::kError, 0.6 * 0.1});
  EXPECT_FALSE(none.recommended);
  ASSERT_TRUE(none.too_fine);
  EXPECT_LE(none.measured.back().voxel_size, 1.5 * kFits);

  for (const AdviceGoal& goal : {AdviceGoal{AdviceGoal::Of::kSlowestQuery, 1e4},
                                 AdviceGoal{AdviceGoal::Of::kError, 0.6 * 6}}) {
    Measures coarse(error, tick, 5);
    const VoxelAdvice advice = coarse.advise(goal);
    ASSERT_TRUE(advice.recommended);
    EXPECT_GE(advice.measured[*advice.recommended].voxel_size, 5);
  }
  Measures nowhere(error, tick, 1e9);
  const VoxelAdvice no = nowhere.advise({AdviceGoal::Of::kError, 1});
  EXPECT_TRUE(no.measured.empty());
  EXPECT_FALSE(no.recommended);
}

}  // namespace
}  // namespace ist::test
