#include "advise/voxel_advice.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "query/triangles/triangle_tree.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr double kCoarsest = 4.4, kFinest = kCoarsest / 256;

using Curve = std::function<double(double)>;

// Measures made up of two curves. Each size is asked once, and has two digits.
class Measures {
 public:
  Measures(Curve error, Curve time, double finest_that_fits = 0)
      : error_(std::move(error)), time_(std::move(time)), finest_(finest_that_fits) {}

  VoxelAdvice advise(AdviceGoal::Of of, double limit) {
    asked_.clear();
    return advise_voxel_size({of, limit}, kCoarsest,
                             [&](double size) -> std::optional<SizeMeasure> {
                               EXPECT_EQ(std::count(asked_.begin(), asked_.end(), size), 0) << size;
                               EXPECT_EQ(std::stod(fmt::format("{:.1e}", size)), size);
                               EXPECT_GE(size, kFinest / 1.1);
                               EXPECT_LE(size, kCoarsest * 1.1);
                               asked_.push_back(size);
                               if (size < finest_) return std::nullopt;
                               SizeMeasure measure{.voxel_size = size};
                               measure.error = error_(size);
                               measure.slowest_query = time_(size);
                               return measure;
                             });
  }
  [[nodiscard]] std::size_t asked() const { return asked_.size(); }

 private:
  Curve error_, time_;
  double finest_;
  std::vector<double> asked_;
};

Curve power(double factor, double exponent) {
  return [=](double size) { return factor * std::pow(size, exponent); };
}

constexpr AdviceGoal::Of kError = AdviceGoal::Of::kError, kTime = AdviceGoal::Of::kSlowestQuery;

// Returns the recommended size, which was measured to meet the goal.
double size_of(const VoxelAdvice& advice, const AdviceGoal& goal) {
  EXPECT_TRUE(std::ranges::is_sorted(advice.measured, std::greater{}, &SizeMeasure::voxel_size));
  if (!advice.recommended) {
    ADD_FAILURE() << "nothing is recommended";
    return 0;
  }
  const SizeMeasure& best = advice.measured[*advice.recommended];
  EXPECT_LE(goal.value(best), goal.limit);
  return best.voxel_size;
}

// The best size of a power law is known. More room never asks for worse voxels.
TEST(VoxelAdvice, IsNearTheBestSizeOfAPowerLaw) {
  for (const double exponent : {0.6, 1.0, 1.7}) {
    Measures measures(power(0.7, exponent), power(40, -exponent));
    double last = 0;
    for (double limit = 0.02; limit < 3; limit *= 1.5) {
      const double best = std::pow(limit / 0.7, 1 / exponent);
      if (best < 1.2 * kFinest) continue;
      SCOPED_TRACE(std::to_string(limit) + " ^ " + std::to_string(exponent));
      const double size = size_of(measures.advise(kError, limit), {kError, limit});
      EXPECT_GE(1.15 * size, std::min(best, kCoarsest));
      EXPECT_GE(size, last);
      EXPECT_LE(measures.asked(), 8u);
      last = size;
    }
    last = kCoarsest;
    for (double limit = 10; limit < 5000; limit *= 1.5) {
      const double best = std::pow(40 / limit, 1 / exponent);
      if (best > kCoarsest / 1.2) continue;
      SCOPED_TRACE(std::to_string(limit) + " ^ " + std::to_string(-exponent));
      const double size = size_of(measures.advise(kTime, limit), {kTime, limit});
      EXPECT_LE(size, 1.15 * std::max(best, kFinest));
      EXPECT_LE(size, last);
      EXPECT_LE(measures.asked(), 8u);
      last = size;
    }
  }
}

// Times are off by a fifth, and the error goes up and down. The recommended size was measured to
// meet the goal all the same.
TEST(VoxelAdvice, StaysNearTheBestSizeDespiteNoise) {
  for (int seed = 1; seed <= samples(200); ++seed) {
    SCOPED_TRACE(seed);
    const auto noisy = [=](const Curve& curve) {
      return [=](double size) { return curve(size) * (1 + 0.2 * std::sin(1e3 * seed * size)); };
    };
    Measures measures(noisy(power(0.6, 1)), noisy(power(40, -1.3)));
    const double timed = size_of(measures.advise(kTime, 250), {kTime, 250});
    EXPECT_NEAR(std::log(timed / std::pow(250 / 40.0, 1 / -1.3)), 0, std::log(1.6));
    const double exact = size_of(measures.advise(kError, 0.1), {kError, 0.1});
    EXPECT_NEAR(std::log(exact / (0.1 / 0.6)), 0, std::log(1.6));
  }
}

// An error may be 0 below a size.
TEST(VoxelAdvice, FindsAStep) {
  Measures measures([](double size) { return size < 0.31 ? 0.0 : 0.5; }, power(40, -1));
  EXPECT_GT(size_of(measures.advise(kError, 0.1), {kError, 0.1}), 0.2);
}

TEST(VoxelAdvice, RecommendsNothingForAGoalOutOfReach) {
  Measures measures([](double) { return 0.5; }, [](double) { return 100.0; });
  const VoxelAdvice timed = measures.advise(kTime, 99);
  EXPECT_FALSE(timed.recommended);
  EXPECT_EQ(timed.measured.size(), 1u);  // finer voxels take longer
  const VoxelAdvice exact = measures.advise(kError, 0.4);
  EXPECT_FALSE(exact.recommended);
  EXPECT_LT(exact.measured.back().voxel_size, 1.1 * kFinest);
}

TEST(VoxelAdvice, EndsWithTheRange) {
  Measures measures(power(1e-3, 1), power(1e-3, -1));
  EXPECT_LT(size_of(measures.advise(kTime, 99), {kTime, 99}), 1.1 * kFinest);
  EXPECT_GT(size_of(measures.advise(kError, 99), {kError, 99}), kCoarsest / 1.1);
}

TEST(VoxelAdvice, ApproachesTheFinestSizeThatFits) {
  constexpr double kFits = 0.15;
  Measures measures(power(0.6, 1), power(40, -1), kFits);
  const VoxelAdvice timed = measures.advise(kTime, 1e4);
  EXPECT_LE(size_of(timed, {kTime, 1e4}), 1.5 * kFits);
  ASSERT_TRUE(timed.too_fine);
  EXPECT_LT(*timed.too_fine, kFits);

  const VoxelAdvice exact = measures.advise(kError, 0.06);
  EXPECT_FALSE(exact.recommended);
  EXPECT_TRUE(exact.too_fine);
  EXPECT_LE(exact.measured.back().voxel_size, 1.5 * kFits);

  Measures nowhere(power(0.6, 1), power(40, -1), 1e9);
  EXPECT_TRUE(nowhere.advise(kError, 1).measured.empty());
}

TEST(VoxelAdvice, FindsNoSizeForBodiesTooDifferent) {
  EXPECT_EQ(coarsest_size(32, 16), 2);
  EXPECT_EQ(coarsest_size(1, 1 << 20), coarsest_size(1 << 20, 1));
  EXPECT_EQ(coarsest_size(1, 1 << 20), 500);
  EXPECT_EQ(coarsest_size(1, 1e8), std::nullopt);
}

// A sphere of radius 2 above the middle of a box. Its lowest vertex is 0.5 above the top, so its
// place alone tells how far the surfaces are apart.
class SphereOnBox : public ::testing::Test {
 protected:
  static constexpr double kHeight = 0.5;

  [[nodiscard]] static TriangleMesh block() { return box({-3, -3, -1.1}, {3, 3, 0}); }
  [[nodiscard]] static TriangleMesh sphere() {
    TriangleMesh mesh = icosphere(4, 2);
    double lowest = 0;
    for (const Eigen::Vector3d& vertex : mesh.vertices) lowest = std::min(lowest, vertex.z());
    return moved(std::move(mesh), {0.0123, -0.0171, kHeight - lowest});
  }
  [[nodiscard]] static Eigen::Isometry3d at(double distance) {
    return Eigen::Isometry3d(Eigen::Translation3d(0, 0, distance - kHeight));
  }
  // The largest distance at which voxels touch, in small steps from far away.
  [[nodiscard]] static double swept_error(double voxel_size) {
    const SphereTree fixed = tree_with_triangles(block(), voxel_size);
    const SphereTree moving = tree_with_triangles(sphere(), voxel_size);
    Query query(fixed, moving);
    double distance = 4 * voxel_size;
    while (distance > 0 && query.leaf_pairs(at(distance), std::span<LeafPair>{}).leaf_pairs == 0) {
      distance -= step(voxel_size);
    }
    return distance;
  }
  [[nodiscard]] static double step(double voxel_size) { return voxel_size / 300; }

  [[nodiscard]] std::optional<SizeMeasure> measure(double voxel_size,
                                                   const MeasureOptions& options) {
    const auto path = find_closing_path(exact_, {2, +1});
    EXPECT_TRUE(path);
    return measure_size(exact_, path->poses(), path, voxel_size, options, progress_);
  }

  const SphereTree fixed_ = triangle_tree(block(), 1), moving_ = triangle_tree(sphere(), 1);
  Query exact_{fixed_, moving_};
  Progress progress_;
  const MeasureOptions brief_{.milliseconds = 1};
};

TEST_F(SphereOnBox, MeasuresTheErrorOfAClosing) {
  for (const double voxel_size : {0.4, 0.17, 0.1}) {
    SCOPED_TRACE(voxel_size);
    const std::optional<SizeMeasure> measured = measure(voxel_size, brief_);
    ASSERT_TRUE(measured);
    EXPECT_NEAR(measured->error, swept_error(voxel_size), 2 * step(voxel_size));
    EXPECT_LE(measured->error, measured->resolution);
    EXPECT_EQ(measured->voxel_size, voxel_size);
    EXPECT_GT(measured->max_leaf_pairs, 0u);
    EXPECT_GT(measured->slowest_query, 0);
    EXPECT_GT(measured->build_milliseconds, 0);
    EXPECT_GT(measured->bytes, 0u);
    EXPECT_EQ(measure(voxel_size, brief_)->error, measured->error);  // no clock decides it
  }
}

TEST_F(SphereOnBox, RecommendsTheLargestVoxelsThatKeepAnError) {
  for (const double error : {0.05, 0.12}) {
    SCOPED_TRACE(error);
    const VoxelAdvice advice = advise_voxel_size(
        {kError, error}, 0.5, [&](double voxel_size) { return measure(voxel_size, brief_); });
    const double size = size_of(advice, {kError, error});
    EXPECT_LE(swept_error(size), error + 2 * step(size));
    EXPECT_GT(swept_error(2 * size), error);
  }
}

TEST_F(SphereOnBox, MeasuresTheErrorAtPoses) {
  const auto error = [&](const std::vector<Eigen::Isometry3d>& poses) {
    return measure_size(exact_, poses, std::nullopt, 0.4, brief_, progress_)->error;
  };
  const double first = swept_error(0.4);
  ASSERT_GT(first, 0.05);
  EXPECT_NEAR(error({at(0.5 * first)}), 0.5 * first, 1e-6);
  EXPECT_EQ(error({at(4)}), 0);
  EXPECT_EQ(error({at(-0.1)}), 0);
  // Between neighbours, either way round.
  EXPECT_NEAR(error({at(4), at(-0.1)}), first, 2 * step(0.4));
  EXPECT_NEAR(error({at(-0.1), at(4)}), first, 2 * step(0.4));
  // The way from a turned pose is not known.
  Eigen::Isometry3d turned = at(4);
  turned.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(error({turned, at(-0.1)}), 0);
}

TEST_F(SphereOnBox, MeasuresNothingThatCannotBeBuilt) {
  MeasureOptions options = brief_;
  options.max_memory = 4 << 20;
  EXPECT_TRUE(measure(0.4, options));
  for (const double voxel_size : {0.02, 1e-9, -1.0, 0.0}) {
    EXPECT_FALSE(measure(voxel_size, options)) << voxel_size;
  }
  options.target = "none";
  EXPECT_EQ(error_name([&] { static_cast<void>(measure(0.4, options)); }), "target-missing");
}

}  // namespace
}  // namespace ist::test
