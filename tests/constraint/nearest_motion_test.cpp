#include "ist/constraint/nearest_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

using Exact = long double;
using ExactVector = Eigen::Matrix<Exact, 6, 1>;
using ExactMatrix = Eigen::Matrix<Exact, 6, 6>;

struct GivenBound {
  Vector6 along;
  double least;
};
struct Problem {
  Matrix6 metric;
  Vector6 wanted;
  std::vector<GivenBound> bounds;
  double tolerance;
};

Vector6 any_vector(Random& random) {
  Vector6 v;
  for (double& x : v) x = random.uniform(-1, 1);
  return v;
}

// A metric of stiffnesses 10^low to 10^high along random axes.
Matrix6 any_metric(Random& random, double low, double high) {
  Eigen::Matrix<double, 6, 6> any;
  for (Eigen::Index i = 0; i < 6; ++i) any.col(i) = any_vector(random);
  const Eigen::Matrix<double, 6, 6> axes = any.householderQr().householderQ();
  Eigen::Matrix<double, 6, 1> stiffness;
  for (double& s : stiffness) s = std::pow(10.0, random.uniform(low, high));
  const Eigen::Matrix<double, 6, 6> metric = axes * stiffness.asDiagonal() * axes.transpose();
  return 0.5 * (metric + metric.transpose());
}

bool solve(NearestMotion& motion, const Problem& problem) {
  motion.clear();
  for (const GivenBound& bound : problem.bounds) {
    EXPECT_TRUE(motion.add(bound.along, bound.least));
  }
  EXPECT_EQ(motion.size(), problem.bounds.size());
  const bool feasible = motion.solve(problem.metric, problem.wanted, problem.tolerance);
  EXPECT_EQ(motion.is_feasible(), feasible);
  if (!feasible) {
    EXPECT_TRUE(motion.motion().isZero(0));
    EXPECT_TRUE(motion.pushes().empty());
  }
  return feasible;
}

Exact energy(const ExactMatrix& metric, const ExactVector& v) { return v.dot(metric * v); }

// The conditions of Karush, Kuhn and Tucker. The problem is convex, so they suffice.
void expect_optimum(const NearestMotion& motion, const Problem& problem) {
  const ExactMatrix metric = problem.metric.cast<Exact>();
  const Eigen::LLT<ExactMatrix> inverse(metric);
  const ExactVector m = motion.motion().cast<Exact>(), wanted = problem.wanted.cast<Exact>();
  const Exact allowed = problem.tolerance + 1e-11L * (1 + m.norm());
  for (const auto& [along, least] : problem.bounds) {
    EXPECT_GE(along.cast<Exact>().dot(m), least - allowed);
  }
  EXPECT_LE(motion.pushes().size(), 6u);
  ExactVector sum = ExactVector::Zero();
  Exact size = std::sqrt(energy(metric, wanted)) + std::sqrt(energy(metric, m));
  for (const auto& [number, force] : motion.pushes()) {
    EXPECT_GE(force, 0);
    const ExactVector along = problem.bounds[number].along.cast<Exact>();
    EXPECT_NEAR(static_cast<double>(along.dot(m)), problem.bounds[number].least,
                static_cast<double>(allowed));
    sum += force * along;
    size += force * std::sqrt(along.dot(inverse.solve(along)));
  }
  const ExactVector off = m - wanted - inverse.solve(sum);
  EXPECT_LE(std::sqrt(energy(metric, off)), 2e-8L * size);
}

// The optimum by trying all sets of independent bounds as the active ones. Empty: no motion obeys.
std::optional<ExactVector> best_of_all_sets(const Problem& problem) {
  const std::size_t count = problem.bounds.size();
  const ExactVector wanted = problem.wanted.cast<Exact>();
  const Eigen::LLT<ExactMatrix> inverse(problem.metric.cast<Exact>());
  constexpr Exact kSmall = 1e-11L;
  for (unsigned set = 0; set < 1u << count; ++set) {
    const int active = std::popcount(set);
    if (active > 6) continue;
    Eigen::Matrix<Exact, 6, Eigen::Dynamic> along(6, active);
    Eigen::Matrix<Exact, Eigen::Dynamic, 1> missing(active);
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if ((set >> i & 1) == 0) continue;
      along.col(at) = problem.bounds[i].along.cast<Exact>();
      missing[at] = problem.bounds[i].least - along.col(at).dot(wanted);
      ++at;
    }
    ExactVector m = wanted;
    if (active > 0) {
      const Eigen::Matrix<Exact, Eigen::Dynamic, Eigen::Dynamic> ways = inverse.solve(along);
      Eigen::FullPivLU<Eigen::Matrix<Exact, Eigen::Dynamic, Eigen::Dynamic>> normal(
          along.transpose() * ways);
      normal.setThreshold(1e-13L);
      if (normal.rank() < active) continue;
      const Eigen::Matrix<Exact, Eigen::Dynamic, 1> forces = normal.solve(missing);
      if (forces.minCoeff() < -kSmall * forces.cwiseAbs().maxCoeff()) continue;
      m += ways * forces;
    }
    if (std::all_of(problem.bounds.begin(), problem.bounds.end(), [&](const GivenBound& bound) {
          return bound.along.cast<Exact>().dot(m) >= bound.least - kSmall * (1 + m.norm());
        })) {
      return m;
    }
  }
  return std::nullopt;
}

TEST(NearestMotion, WithoutBoundsIsTheWantedOne) {
  Random random(1);
  NearestMotion motion(4);
  for (int i = 0; i < samples(100); ++i) {
    Vector6 wanted = any_vector(random);
    wanted[random.below(6)] = -0.0;
    EXPECT_TRUE(motion.solve(any_metric(random, -3, 6), wanted, 0));
    for (Eigen::Index k = 0; k < 6; ++k) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(motion.motion()[k]),
                std::bit_cast<std::uint64_t>(wanted[k]));
    }
    EXPECT_TRUE(motion.pushes().empty());
  }
}

// Whole numbers: many bounds are equal, parallel, opposite or dependent, and meet in one point.
TEST(NearestMotion, IsTheBestOfAllActiveSets) {
  Random random(2);
  NearestMotion motion(8);
  int feasible = 0, infeasible = 0;
  for (int i = 0; i < samples(2'000) && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    Problem problem{any_metric(random, 0, 3), 3 * any_vector(random), {}, 1e-11};
    const std::size_t rank = 1 + random.below(6);
    for (std::size_t count = 1 + random.below(8); count > 0; --count) {
      Vector6 along = Vector6::Zero();
      for (std::size_t k = 0; k < rank; ++k) {
        along[static_cast<Eigen::Index>(k)] = static_cast<double>(random.below(3)) - 1;
      }
      problem.bounds.push_back({along, static_cast<double>(random.below(5)) - 3});
    }
    const std::optional<ExactVector> best = best_of_all_sets(problem);
    ASSERT_EQ(solve(motion, problem), best.has_value());
    ++(best ? feasible : infeasible);
    if (!best) continue;
    expect_optimum(motion, problem);
    EXPECT_LE((motion.motion().cast<Exact>() - *best).norm(), 1e-9L * (1 + best->norm()));
  }
  EXPECT_GT(feasible, least(500, 50));
  EXPECT_GT(infeasible, least(200, 20));
}

// A problem that one motion solves at least. Bounds repeat, lie opposite, depend on each other, and
// many meet at that motion.
Problem solvable(Random& random, std::size_t bounds) {
  Problem problem{any_metric(random, -3, 6), any_vector(random), {}, 1e-9};
  const Vector6 inside = any_vector(random), axis = any_vector(random);
  for (std::size_t i = 0; i < bounds; ++i) {
    Vector6 along = any_vector(random);
    if (i > 0) {
      const Vector6& other = problem.bounds[random.below(i)].along;
      switch (random.below(8)) {
        case 0:
          along = other;
          break;
        case 1:
          along = -other;
          break;
        case 2:
          along = random.uniform(0.1, 3) * other + random.uniform(-1, 1) * axis;
          break;
        case 3:
          along = other + 0.1 * along;
          break;
        default:
          break;
      }
    }
    const double slack = random.below(2) == 0 ? 0 : random.uniform(0, 0.3);
    problem.bounds.push_back({along, along.dot(inside) - slack});
  }
  return problem;
}

TEST(NearestMotion, MeetsTheConditionsOfAnOptimum) {
  Random random(3);
  NearestMotion motion(4'000);
  std::size_t pushes = 0;
  for (int i = 0; i < samples(3'000); ++i) {
    SCOPED_TRACE(i);
    const std::size_t bounds = i % 300 == 0 ? 4'000 : i % 10 == 0 ? 300 : 1 + random.below(20);
    const Problem problem = solvable(random, bounds);
    ASSERT_TRUE(solve(motion, problem));
    expect_optimum(motion, problem);
    pushes += motion.pushes().size();
  }
  EXPECT_GT(pushes, samples(6'000u));
}

// Forces that sum to nothing and would do work on every motion: by the lemma of Farkas.
TEST(NearestMotion, SaysThatNoMotionObeys) {
  Random random(4);
  NearestMotion motion(64);
  for (int i = 0; i < samples(3'000); ++i) {
    SCOPED_TRACE(i);
    Problem problem = solvable(random, 1 + random.below(20));
    const std::size_t count = 1 + random.below(6);
    const Vector6 at = any_vector(random);
    Vector6 sum = Vector6::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const Vector6 along = any_vector(random);
      problem.bounds.push_back({along, along.dot(at)});
      sum += random.uniform(0.1, 1) * along;
    }
    problem.bounds.push_back({-sum, -sum.dot(at) + std::pow(10.0, random.uniform(-6, 0))});
    for (std::size_t k = problem.bounds.size(); k > 1; --k) {
      std::swap(problem.bounds[k - 1], problem.bounds[random.below(k)]);
    }
    EXPECT_FALSE(solve(motion, problem));
  }
  Problem nothing{Matrix6::Identity(), any_vector(random), {{Vector6::Zero(), 1e-3}}, 1e-9};
  EXPECT_FALSE(solve(motion, nothing));
  nothing.bounds[0].least = -1e-3;
  EXPECT_TRUE(solve(motion, nothing));
  EXPECT_EQ(motion.motion(), nothing.wanted);
}

TEST(NearestMotion, DoesNotDependOnTheOrderOfBounds) {
  Random random(5);
  NearestMotion motion(300);
  for (int i = 0; i < samples(500); ++i) {
    SCOPED_TRACE(i);
    Problem problem = solvable(random, 1 + random.below(300));
    problem.tolerance = 1e-10;
    ASSERT_TRUE(solve(motion, problem));
    const ExactVector first = motion.motion().cast<Exact>();
    const ExactMatrix metric = problem.metric.cast<Exact>();
    for (int k = 0; k < 3; ++k) {
      std::reverse(problem.bounds.begin(),
                   problem.bounds.begin() +
                       static_cast<std::ptrdiff_t>(random.below(problem.bounds.size() + 1)));
      std::reverse(problem.bounds.begin(), problem.bounds.end());
      ASSERT_TRUE(solve(motion, problem));
      const ExactVector off = motion.motion().cast<Exact>() - first;
      EXPECT_LE(energy(metric, off), 1e-9L * (1e-6L + energy(metric, first)));
    }
  }
}

// Without stiffness in some directions there is no nearest motion, but one that obeys.
TEST(NearestMotion, ObeysABoundInASingularMetric) {
  Random random(6);
  NearestMotion motion(20);
  for (int i = 0; i < samples(1'000); ++i) {
    SCOPED_TRACE(i);
    Problem problem{Matrix6::Zero(), any_vector(random), {}, 1e-6};
    const Vector6 inside = any_vector(random);
    const Vector6 along = any_vector(random);
    problem.bounds.assign(1 + random.below(3), {along, along.dot(inside)});
    const double stiffness = std::pow(10.0, random.uniform(-3, 6));
    for (Eigen::Index k = 0; k < 6; ++k) {
      if (random.below(2) == 0) problem.metric(k, k) = random.uniform(0.1, 1) * stiffness;
    }
    ASSERT_TRUE(solve(motion, problem));
    ASSERT_TRUE(motion.motion().allFinite());
    for (const auto& [along, least] : problem.bounds) {
      EXPECT_GE(along.dot(motion.motion()), least - 1e-5 * (1 + motion.motion().norm()));
    }
  }
}

// A slot that is narrower than its walls ask for, and opens by 1e-9: no motion of 500 m.
TEST(NearestMotion, IsNoneBetweenWallsThatAreNearlyParallel) {
  Random random(7);
  NearestMotion motion(2);
  for (int i = 0; i < samples(500); ++i) {
    const Vector6 along = any_vector(random).normalized();
    const Vector6 other = -along + 1e-9 * any_vector(random);
    const Problem slot{
        any_metric(random, 1, 3), any_vector(random), {{along, 5e-6}, {other, 5e-6}}, 5e-12};
    EXPECT_FALSE(solve(motion, slot));
  }
}

TEST(NearestMotion, PushesAgainstOnePlaneByItsStiffness) {
  NearestMotion motion(1);
  const Matrix6 metric = Vector6::Constant(1'000).asDiagonal();
  EXPECT_TRUE(motion.add(Vector6::Unit(2), -0.001));
  EXPECT_FALSE(motion.add(Vector6::Unit(1), 0));
  EXPECT_EQ(motion.size(), 1u);
  Vector6 wanted = -0.004 * Vector6::Unit(2);
  wanted[4] = 0.5;
  ASSERT_TRUE(motion.solve(metric, wanted, 1e-12));
  ASSERT_EQ(motion.pushes().size(), 1u);
  EXPECT_EQ(motion.pushes()[0].bound, 0u);
  EXPECT_NEAR(motion.pushes()[0].force, 3, 1e-12);
  EXPECT_NEAR(motion.motion()[2], -0.001, 1e-15);
  EXPECT_NEAR(motion.motion()[4], 0.5, 1e-15);
  motion.clear();
  EXPECT_EQ(motion.size(), 0u);
}

}  // namespace
}  // namespace ist::test
