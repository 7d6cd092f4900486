#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ist/mesh/triangles_meet.h"
#include "simd/dispatch.h"
#include "simd/targets.h"
#include "simd/triangles/triangle_lanes.h"
#include "support/effort.h"
#include "support/random.h"

namespace ist::test {
namespace {

struct PairOfTriangles {
  TriangleCorners a, b;
};

TriangleCorners random_triangle(Random& random, double size) {
  TriangleCorners t;
  for (Eigen::Vector3d& p : t) p = random.point(-size, size);
  return t;
}

// Triangles that meet, miss, touch with corners, edges and planes, and slivers of all sorts.
PairOfTriangles random_pair(Random& random, double size) {
  PairOfTriangles pair{random_triangle(random, size), random_triangle(random, size)};
  const auto nudge = [&] {
    return std::ldexp(size * random.uniform(-1, 1), -static_cast<int>(random.below(40)));
  };
  switch (random.below(6)) {
    case 0:  // a corner near the other's plane, in it or beside it
      pair.b[0] = pair.a[0] + random.uniform(-0.2, 1) * (pair.a[1] - pair.a[0]) +
                  random.uniform(-0.2, 1) * (pair.a[2] - pair.a[0]) + nudge() * random.direction();
      break;
    case 1:  // edges that nearly cross
      pair.b[1] = 2 * (pair.a[0] + random.uniform(0, 1) * (pair.a[1] - pair.a[0])) - pair.b[0] +
                  nudge() * random.direction();
      break;
    case 2:  // slivers
      pair.a[2] =
          pair.a[0] + random.uniform(0, 1) * (pair.a[1] - pair.a[0]) + nudge() * random.direction();
      break;
    case 3:  // nearly in one plane
      for (Eigen::Vector3d& p : pair.b) {
        p = pair.a[0] + random.uniform(-1, 1) * (pair.a[1] - pair.a[0]) +
            random.uniform(-1, 1) * (pair.a[2] - pair.a[0]) + nudge() * random.direction();
      }
      break;
    default:
      break;
  }
  return pair;
}

// Decides pairs by a target's kernel: 1 meet, 0 apart, -1 open.
class Decider {
 public:
  explicit Decider(const std::string& target)
      : kernels_(select_kernels(target).clusters), ids_(4 * kLength) {}

  void add(const LaneTriangle& a, const LaneTriangle& b, float error) {
    if (batch_.count == TriangleBatch::kSize) decide();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        batch_.fixed[k][i][batch_.count] = a[k][i];
        batch_.moving[k][i][batch_.count] = b[k][i];
      }
    }
    batch_.error[batch_.count] = error;
    batch_.fixed_id[batch_.count] = static_cast<std::uint32_t>(answers_.size());
    batch_.moving_id[batch_.count++] = 7;
    answers_.push_back(0);
  }
  const std::vector<int>& answers() {
    decide();
    return answers_;
  }

 private:
  static constexpr std::size_t kLength = FoundTriangles::kRoom + kClusterWidth;
  void decide() {
    FoundTriangles found{{ids_.data(), ids_.data() + kLength},
                         {ids_.data() + 2 * kLength, ids_.data() + 3 * kLength}};
    kernels_.decide_triangles(batch_, found);
    for (std::size_t k = 0; k < found.certain.count; ++k) {
      answers_[found.certain[k].fixed] = 1;
      EXPECT_EQ(found.certain[k].moving, 7u);
    }
    for (std::size_t k = 0; k < found.open.count; ++k) answers_[found.open[k].fixed] = -1;
    EXPECT_EQ(batch_.count, 0u);
  }

  const ClusterKernels& kernels_;
  std::vector<std::uint32_t> ids_;
  TriangleBatch batch_;
  std::vector<int> answers_;
};

class TriangleDecision : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Targets, TriangleDecision, ::testing::ValuesIn(all_targets()), name_of);

// Each coordinate is off by the largest allowed error, up or down at random. That is the worst case
// for a determinant. The decisions stay the same.
TEST_P(TriangleDecision, IsRightWhateverTheCoordinatesErr) {
  for (const double size : {1.0, 1e-6, 1e6, 1e-10, 1e-12, 1e-13, 1e-14, 1e12, 1e13}) {
    for (const double relative : {0x1p-23, 0x1p-20, 0x1p-12, 0x1p-6}) {
      Random random(17);
      Decider decider(GetParam());
      std::vector<bool> truth;
      const double error = relative * size;
      for (int i = 0; i < samples(3000); ++i) {
        const PairOfTriangles pair = random_pair(random, size);
        truth.push_back(triangles_meet(pair.a, pair.b));
        // A difference of two coordinates, each off by half the error.
        const auto disturbed = [&](const TriangleCorners& t) {
          LaneTriangle lane;
          for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t j = 0; j < 3; ++j) {
              const double by = random.below(2) == 0 ? 0.5 * error : -0.5 * error;
              lane[k][j] = static_cast<float>(t[k][static_cast<Eigen::Index>(j)] + by);
            }
          }
          return lane;
        };
        const LaneTriangle a = disturbed(pair.a), b = disturbed(pair.b);
        decider.add(a, b, static_cast<float>(error + 0x1p-22 * size));
      }
      const std::vector<int>& answers = decider.answers();
      std::size_t open = 0, met = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        open += answers[i] < 0 ? 1U : 0U;
        met += answers[i] > 0 ? 1U : 0U;
        if (answers[i] < 0) continue;
        ASSERT_EQ(answers[i] > 0, truth[i]) << i << " of size " << size;
      }
      if (relative < 0x1p-19 && size > 1e-9 && size < 1e12) {
        EXPECT_LT(open, truth.size() * 2 / 5);
        EXPECT_GT(met, truth.size() / 40);
      }
    }
  }
}

// Coordinates that floats hold have no error. Only determinants are rounded. Most of them are
// nearly or exactly 0 here.
TEST_P(TriangleDecision, IsRightWhereRoundingAloneErrs) {
  Random random(19);
  Decider decider(GetParam());
  std::vector<bool> truth;
  const auto narrowed = [](TriangleCorners& t) {
    LaneTriangle lane;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        double& x = t[k][static_cast<Eigen::Index>(j)];
        lane[k][j] = static_cast<float>(x);
        x = double{lane[k][j]};
      }
    }
    return lane;
  };
  for (int i = 0; i < samples(20000); ++i) {
    PairOfTriangles pair = random_pair(random, 1);
    const LaneTriangle a = narrowed(pair.a), b = narrowed(pair.b);
    truth.push_back(triangles_meet(pair.a, pair.b));
    decider.add(a, b, 0);
  }
  const std::vector<int>& answers = decider.answers();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (answers[i] < 0) continue;
    ASSERT_EQ(answers[i] > 0, truth[i]) << i;
  }
}

// Far from any doubt nothing is open.
TEST_P(TriangleDecision, LeavesNothingOpenThatIsPlain) {
  Decider decider(GetParam());
  const LaneTriangle flat = {LanePoint{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
  std::vector<int> wanted;
  for (int i = 0; i < 50; ++i) {
    const float x = 0.01F * static_cast<float>(i);
    decider.add(flat, {LanePoint{x, 0, -1}, {x, 0.1F, 1}, {x + 0.1F, 0, 1}}, 1e-6F);
    wanted.push_back(1);
    decider.add(flat, {LanePoint{x, 0, 1}, {x, 0.1F, 2}, {x + 0.1F, 0, 2}}, 1e-6F);
    wanted.push_back(0);
    decider.add({LanePoint{x, 5, -1}, {x, 5.1F, 1}, {x + 0.1F, 5, 1}}, flat, 1e-6F);
    wanted.push_back(0);
  }
  EXPECT_EQ(decider.answers(), wanted);
}

// With an error beyond all bounds, and with coordinates whose products float does not hold.
TEST_P(TriangleDecision, LeavesAllOpenWhereFloatKnowsNothing) {
  const LaneTriangle a = {LanePoint{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
  const LaneTriangle b = {LanePoint{0, 0, -1}, {0, 0.1F, 1}, {0.1F, 0, 1}};
  const auto scaled = [](LaneTriangle t, float by) {
    for (LanePoint& p : t) {
      for (float& x : p) x *= by;
    }
    return t;
  };
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  Decider decider(GetParam());
  for (const float error : {1e3F, kInfinite, std::nanf("")}) decider.add(a, b, error);
  for (const float by : {1e14F, 1e18F, 1e30F, 1e-17F, 1e-25F, 1e-38F}) {
    decider.add(scaled(a, by), scaled(b, by), 1e-6F * by);
  }
  for (const int answer : decider.answers()) EXPECT_EQ(answer, -1);
}

// The vector forms decide no less than the scalar one, but for a few whose rounding differs.
TEST_P(TriangleDecision, IsOpenAsSeldomAsTheScalarForm) {
  Random random(5);
  Decider decider(GetParam());
  std::size_t open = 0;
  for (int i = 0; i < 4000; ++i) {
    const PairOfTriangles pair = random_pair(random, 1);
    LaneTriangle a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        a[k][j] = static_cast<float>(pair.a[k][static_cast<Eigen::Index>(j)]);
        b[k][j] = static_cast<float>(pair.b[k][static_cast<Eigen::Index>(j)]);
      }
    }
    decider.add(a, b, 0x1p-22F);
    open += decide(a, b, 0x1p-22F) == Decision::kOpen ? 1U : 0U;
  }
  const auto& answers = decider.answers();
  const auto mine = static_cast<std::size_t>(std::count(answers.begin(), answers.end(), -1));
  EXPECT_NEAR(static_cast<double>(mine), static_cast<double>(open),
              0.01 * static_cast<double>(open) + 2);
}

}  // namespace
}  // namespace ist::test
