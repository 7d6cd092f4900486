#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "simd/guarded.h"
#include "simd/lanes.h"
#include "simd/plan_cases.h"
#include "simd/targets.h"

namespace ist::test {
namespace {

// Each part of a vector kernel against the scalar form, bit for bit.
class StepParts : public ::testing::TestWithParam<std::string> {
 protected:
  const ist::StepParts& scalar_ = kScalarKernels.parts;
  const ist::StepParts& vector_ = select_kernels(GetParam()).parts;
};

INSTANTIATE_TEST_SUITE_P(Targets, StepParts, ::testing::ValuesIn(vector_targets()), name_of);

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

std::unique_ptr<MovingLanes> marked() {
  auto lanes = std::make_unique<MovingLanes>();
  std::memset(static_cast<void*>(lanes.get()), 0xA5, sizeof(MovingLanes));
  return lanes;
}

TEST_P(StepParts, DecodeTheSameBounds) {
  Random random(1);
  for (const auto& search : all_plans()) {
    const std::size_t lanes = search->policy == SpherePolicy::kSlab ? kLanes : kRadius + 1;
    for (std::size_t step = 0; step < search->plan.steps().size(); ++step) {
      const SearchStep& by = search->plan.steps()[step];
      const PlannedSearch::Names& names = search->names[step];
      for (const auto& [side, nodes] :
           {std::pair(&by.fixed, &names.fixed), {&by.moving, &names.moving}}) {
        for (const std::uint32_t node : *nodes) {
          const auto wanted = marked(), made = marked();
          const std::size_t at = random.below(MovingLanes::kSize - 7);
          const std::size_t count = scalar_.decode(*side, node, *wanted, at);
          ASSERT_EQ(vector_.decode(*side, node, *made, at), count);
          for (std::size_t i = 0; i < MovingLanes::kSize + 16; ++i) {
            if (i >= at + count && i < at + 16) continue;  // may be written, and is not read
            ASSERT_EQ(made->id[i], wanted->id[i]);
            for (std::size_t lane = 0; lane < lanes; ++lane) {
              ASSERT_TRUE(same_bits(made->lane[lane][i], wanted->lane[lane][i]))
                  << "lane " << lane << " of node " << node;
            }
          }
        }
      }
    }
  }
}

TEST_P(StepParts, TurnTheSameRows) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const SearchPose pose = random_pose(random, 0.1);
    const float scale = std::ldexp(1.0F, static_cast<int>(random.below(120)) - 60);
    FixedLanes fixed{};
    for (auto& lane : fixed.lane) {
      for (float& x : lane) x = scale * static_cast<float>(random.uniform(-1, 1));
    }
    for (const bool slabs : {false, true}) {
      FixedRows wanted{}, made{};
      scalar_.turn(pose, slabs, fixed, wanted);
      vector_.turn(pose, slabs, fixed, made);
      ASSERT_EQ(std::memcmp(&made, &wanted, sizeof(FixedRows)), 0);
    }
  }
}

class OverlapRow : public StepParts {
 protected:
  // Every row against lanes of every length, from every place where groups begin.
  std::size_t expect_same(const FixedRows& rows, const MovingLanes& moving, Random& random) {
    std::size_t touching = 0;
    for (const bool slabs : {false, true}) {
      for (std::size_t length = 0; length <= 65; ++length) {
        const std::size_t begin = 16 * random.below(60), row = random.below(8);
        std::vector<std::uint32_t> wanted(length);
        wanted.resize(
            scalar_.overlap_row(rows, row, moving, begin, begin + length, slabs, wanted.data()));
        Guarded<std::uint32_t> made(wanted.size() + 16, random.below(16));
        EXPECT_EQ(vector_.overlap_row(rows, row, moving, begin, begin + length, slabs, made.data()),
                  wanted.size());
        EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), made.data()));
        EXPECT_TRUE(made.intact());
        touching += wanted.size();
        expect_same_measure(rows, row, moving, begin, begin + length, slabs, wanted);
      }
    }
    return touching;
  }
  // The same pairs, and the same bits of all that is measured.
  void expect_same_measure(const FixedRows& rows, std::size_t row, const MovingLanes& moving,
                           std::size_t begin, std::size_t end, bool slabs,
                           const std::vector<std::uint32_t>& touching) {
    DistanceBounds wanted, measured;
    std::vector<std::uint32_t> scalar(end - begin);
    EXPECT_EQ(scalar_.measure_row(rows, row, moving, begin, end, slabs, scalar.data(), wanted),
              touching.size());
    Guarded<std::uint32_t> made(touching.size() + 16, 3);
    EXPECT_EQ(vector_.measure_row(rows, row, moving, begin, end, slabs, made.data(), measured),
              touching.size());
    EXPECT_TRUE(std::equal(touching.begin(), touching.end(), made.data()));
    EXPECT_TRUE(made.intact());
    EXPECT_EQ(measured.min_pruned, wanted.min_pruned);
    EXPECT_EQ(measured.min_overlapping, wanted.min_overlapping);
    EXPECT_EQ(measured.upper, wanted.upper);
  }
  template <class Number>
  void fill(const Number& number) {
    for (auto& lane : moving_->lane) {
      for (float& x : lane) x = number();
    }
    for (float* numbers : {rows_.x, rows_.y, rows_.z, rows_.radius, rows_.normal_x, rows_.normal_y,
                           rows_.normal_z, rows_.offset, rows_.half, rows_.scaled_radius}) {
      for (int row = 0; row < 8; ++row) numbers[row] = number();
    }
    for (std::uint32_t i = 0; i < MovingLanes::kSize + 16; ++i) moving_->id[i] = 1000000007 * i;
  }

  FixedRows rows_{};
  const std::unique_ptr<MovingLanes> moving_ = std::make_unique<MovingLanes>();
};

INSTANTIATE_TEST_SUITE_P(Targets, OverlapRow, ::testing::ValuesIn(vector_targets()), name_of);

// Small whole numbers: many are as far apart as they reach, exactly.
TEST_P(OverlapRow, WhereBoundsAreTangent) {
  Random random(3);
  std::size_t touching = 0;
  for (int i = 0; i < 100 && !HasFailure(); ++i) {
    fill([&] { return static_cast<float>(random.below(7)) - 3; });
    touching += expect_same(rows_, *moving_, random);
  }
  EXPECT_GT(touching, 20'000u);
  EXPECT_LT(touching, 200'000u);
}

// Reaches within some last bits of the distance: one operation that rounds otherwise shows.
TEST_P(OverlapRow, WhereTheLastBitDecides) {
  Random random(4);
  std::size_t touching = 0;
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    fill([&] { return static_cast<float>(random.uniform(-1, 1)); });
    const std::size_t row = random.below(8);
    FixedRows rows = rows_;
    for (int other = 0; other < 8; ++other) {  // all rows alike
      for (auto numbers : {&FixedRows::x, &FixedRows::y, &FixedRows::z, &FixedRows::normal_x,
                           &FixedRows::normal_y, &FixedRows::normal_z, &FixedRows::offset}) {
        (rows.*numbers)[other] = (rows_.*numbers)[row];
      }
      rows.radius[other] = rows.half[other] = rows.scaled_radius[other] = 0;
    }
    auto& m = moving_->lane;
    for (std::size_t at = 0; at < MovingLanes::kSize; ++at) {
      const double dx = double{m[kX][at]} - rows.x[0], dy = double{m[kY][at]} - rows.y[0],
                   dz = double{m[kZ][at]} - rows.z[0];
      const auto near = [&](double value) {
        return static_cast<float>(value * (1 + random.uniform(-2, 2) * 0x1p-23));
      };
      const double above_fixed =
          dx * rows.normal_x[0] + dy * rows.normal_y[0] + dz * rows.normal_z[0] - rows.offset[0];
      const double above_moving =
          dx * m[kNormalX][at] + dy * m[kNormalY][at] + dz * m[kNormalZ][at] + m[kOffset][at];
      const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
      m[kRadius][at] = near(std::max(distance, std::abs(above_fixed)));
      m[kHalf][at] = near(std::abs(above_moving));
    }
    touching += expect_same(rows, *moving_, random);
  }
  EXPECT_GT(touching, 50'000u);
}

// Rejected by `>`: what cannot be compared is kept.
TEST_P(OverlapRow, WhatIsNoNumberIsKept) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Random random(5);
  for (int i = 0; i < 50 && !HasFailure(); ++i) {
    fill([&] { return random.below(20) == 0 ? kNan : static_cast<float>(random.uniform(-1, 1)); });
    expect_same(rows_, *moving_, random);
  }
  fill([&] { return kNan; });
  EXPECT_EQ(expect_same(rows_, *moving_, random), 65u * 66);
}

}  // namespace
}  // namespace ist::test
