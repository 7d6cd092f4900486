#include "ist/hardware/pair_test.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hardware/exact_pair.h"
#include "hardware/golden_vectors.h"
#include "ist/hardware/quantized_pose.h"
#include "ist/hardware/table_rom.h"
#include "ist/tree/lookup_table.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/exact.h"

namespace ist::test {
namespace {

mpz_class power(unsigned exponent) { return mpz_class(1) << exponent; }

mpz_class ceil_of(const mpq_class& x) { return -floor_of(-x); }

// The smallest whole number with a square of at least `square`.
mpz_class root_up(const mpz_class& square) {
  mpz_class root = sqrt(square);
  return root * root < square ? mpz_class(root + 1) : root;
}

// README.md's seven steps in numbers without a width, and from the table that trees use.
PairAnswer answer_by_the_book(const NodePair& pair, const PairRegisters& registers) {
  const TableBall fixed = kLookupTable[pair.fixed_mask], moving = kLookupTable[pair.moving_mask];
  const int fixed_offset[] = {fixed.x, fixed.y, fixed.z};
  const int moving_offset[] = {moving.x, moving.y, moving.z};
  std::array<mpz_class, 3> distance;
  for (std::size_t i = 0; i < 3; ++i) {
    mpq_class turned = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      turned += mpq_class(moving_offset[k] * registers.rotation[3 * k + i], 1 << 16);
    }
    turned *= power(pair.moving_level);
    distance[i] = pair.moving_centre[i] + floor_of(turned * 256) -
                  256 * (pair.fixed_centre[i] + fixed_offset[i] * power(pair.fixed_level));
  }
  mpz_class reach = registers.pad;
  reach += root_up(65536 * mpz_class{fixed.radius_squared}) * power(pair.fixed_level);
  for (std::size_t code = 0; code < 5; ++code) {
    if (std::array{27, 54, 81, 96, 108}[code] != moving.radius_squared) continue;
    reach += registers.radius[code] * power(pair.moving_level);
  }
  bool hit = pair.fixed_mask != 0 && pair.moving_mask != 0;
  const std::size_t bits = mpz_sizeinbase(reach.get_mpz_t(), 2);
  const mpz_class cut = power(bits > 15 ? static_cast<unsigned>(bits - 15) : 0);
  mpz_class squared = 0;
  for (const mpz_class& d : distance) {
    const mpz_class n = floor_of(mpq_class(abs(d)) / cut);
    squared += n * n;
    if (abs(d) > reach) hit = false;
  }
  const mpz_class longest = ceil_of(mpq_class(reach) / cut);
  return {reach.get_ui(), hit && squared <= longest * longest};
}

TEST(PairTest, IsWhatTheReadmeSays) {
  GoldenVectors vectors(7);
  std::size_t hits = 0;
  const std::size_t asked = corner_cases().size() + samples(std::size_t{20'000});
  for (std::size_t i = 0; i < asked; ++i) {
    const GoldenVector vector = vectors.next();
    ASSERT_EQ(test_pair(vector.pair, vector.registers), vector.answer) << i;
    const PairAnswer book = answer_by_the_book(vector.pair, vector.registers);
    ASSERT_EQ(vector.answer.reach, book.reach) << i;
    ASSERT_EQ(vector.answer.hit, book.hit) << i;
    hits += book.hit ? 1 : 0;
  }
  EXPECT_GT(hits, asked / 3);
  EXPECT_LT(hits, asked * 2 / 3);
}

// The widths that README.md guarantees, at the ends of the registers.
TEST(PairTest, NumbersHaveTheBitsThatTheReadmeGives) {
  std::int64_t farthest = 0;
  std::uint64_t reach = 0;
  for (const GoldenVector& vector : corner_cases()) {
    for (const std::int64_t d : ball_distance(vector.pair, vector.registers)) {
      farthest = std::max(farthest, std::abs(d));
    }
    reach = std::max(reach, vector.answer.reach);
  }
  EXPECT_LT(farthest, std::int64_t{1} << 32);
  EXPECT_GT(farthest, std::int64_t{3} << 30) << "the corner cases do not go so far";
  EXPECT_EQ(reach, ((2661u + 65535u) * std::uint64_t{65536}) + 65535);
  EXPECT_LT(reach, std::uint64_t{1} << 33);
}

TEST(TableRom, HoldsTheTable) {
  for (std::size_t mask = 1; mask < 256; ++mask) {
    const TableBall ball = kLookupTable[mask];
    const std::uint16_t word = table_rom()[mask];
    EXPECT_EQ(rom_coordinate(word, 0), ball.x) << mask;
    EXPECT_EQ(rom_coordinate(word, 1), ball.y) << mask;
    EXPECT_EQ(rom_coordinate(word, 2), ball.z) << mask;
    ASSERT_LT(rom_radius_code(word), 5u) << mask;
    EXPECT_EQ(kRadiusSquared[rom_radius_code(word)], ball.radius_squared) << mask;
    EXPECT_LT(word, 1 << 12) << mask;
  }
  EXPECT_EQ(rom_radius_code(table_rom()[0]), kNoRadius);
}

TEST(TableRom, FixedRadiiAreTheRootsRoundedUp) {
  for (std::size_t code = 0; code < 5; ++code) {
    EXPECT_EQ(kFixedRadii[code], root_up(mpz_class(kRadiusSquared[code]) << 16)) << code;
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(QuantizedPose, OfBodiesThatAreNotTurned) {
  const Lattice lattice = centred_lattice(4);
  const QuantizedPose pose = quantize_pose(shift({10, -20, 0.5}), lattice, lattice);
  EXPECT_EQ(pose.registers.rotation,
            (std::array<std::int32_t, 9>{65536, 0, 0, 0, 65536, 0, 0, 0, 65536}));
  // 2304 for 9, rounded up by the error of the rotation.
  EXPECT_EQ(pose.registers.radius, (std::array<std::uint16_t, 5>{1331, 1882, 2305, 2509, 2661}));
  EXPECT_EQ(pose.registers.pad, 4);
  EXPECT_EQ(move_centre(pose, {6, -6, 18}), (std::array<std::int32_t, 3>{4096, -6656, 4736}));
}

TEST(QuantizedPose, ColumnsAreImagesOfMovingAxes) {
  const Lattice lattice = centred_lattice(4), finer = centred_lattice(5, 6);
  const Eigen::Matrix3d turn = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
  const QuantizedPose pose = quantize_pose(pose_of(turn, {0, 0, 0}), lattice, finer);
  EXPECT_EQ(pose.registers.rotation,
            (std::array<std::int32_t, 9>{0, 32768, 0, -32768, 0, 0, 0, 0, 32768}));
  EXPECT_EQ(move_centre(pose, {6, 0, 18}), (std::array<std::int32_t, 3>{0, 768, 2304}));
}

// The registers hold the moving radii with what turning the offset errs by, rounded up: 2⁻¹⁷ times
// |x| + |y| + |z| of it, times √3.
TEST(QuantizedPose, RadiiHoldTheBallAndTheErrorOfItsOffset) {
  const std::array<int, 5> squared = {27, 54, 81, 96, 108}, sums = {9, 6, 3, 6, 0};
  const auto check = [&](std::size_t code, double ratio) {
    const PairRegisters registers = make_registers(Eigen::Matrix3d::Identity(), ratio, 0);
    const mpq_class root = 256 * mpq_class(ratio);
    const mpq_class of_offset = mpq_class(256 * sums[code], 1 << 17) * mpq_class(kSqrt3);
    const mpq_class without = registers.radius[code] - of_offset;
    EXPECT_TRUE(without >= 0 && without * without >= root * root * squared[code])
        << ratio << ' ' << code;
    const mpq_class less = without - mpq_class(1000001, 1000000);
    EXPECT_TRUE(less <= 0 || less * less < root * root * squared[code]) << ratio << ' ' << code;
  };
  for (std::size_t code = 0; code < 5; ++code) {
    for (const double ratio : {0x1p-30, 0.001, 0.3, 1.0, 2.7, 7.999}) check(code, ratio);
    // The ball alone would fit with one bit less.
    const double of_unit = 256 * std::sqrt(static_cast<double>(squared[code]));
    for (int last = 1; last < 8 * 1330; last += 37) check(code, (last - 1e-6) / of_unit);
  }
}

// Bit for bit what exact arithmetic gives with the registers, rounded down. The centres go to the
// ends of the trees.
TEST(QuantizedPose, MovesCentresByTheBook) {
  Random random(1);
  for (int i = 0; i < samples(3000); ++i) {
    const Lattice fixed = centred_lattice(16), moving = centred_lattice(16, random.uniform(1, 50));
    const QuantizedPose pose =
        quantize_pose(pose_of(random.rotation(), 12 * random.point(-1e5, 1e5)), fixed, moving);
    std::array<std::int32_t, 3> centre{};
    for (std::int32_t& x : centre) {
      x = i % 2 == 0 ? kMaxCentre * (random.below(2) == 0 ? 1 : -1)
                     : static_cast<std::int32_t>(random.below(2 * kMaxCentre)) - kMaxCentre;
    }
    const std::array<std::int32_t, 3> moved = move_centre(pose, centre);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mpz_class sum = static_cast<long>(pose.translation[axis]);
      for (std::size_t k = 0; k < 3; ++k) {
        sum += mpz_class(pose.rotation[3 * k + axis]) * centre[k];
      }
      mpz_class down;
      mpz_fdiv_q_2exp(down.get_mpz_t(), sum.get_mpz_t(), 20);
      ASSERT_EQ(down, moved[axis]) << i;
    }
  }
}

TEST(QuantizedPose, RefusesWhatIsNoMotion) {
  const Lattice lattice = centred_lattice(4);
  const auto error = [&](const Eigen::Isometry3d& pose) {
    return error_name([&] { static_cast<void>(quantize_pose(pose, lattice, lattice)); });
  };
  for (int i = 0; i < 16; ++i) {
    Eigen::Isometry3d pose = shift({1, 2, 3});
    pose.matrix().data()[i] = kNan;
    EXPECT_EQ(error(pose), "pose-invalid") << i;
    pose.matrix().data()[i] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error(pose), "pose-invalid") << i;
  }
  EXPECT_EQ(error(pose_of(-Eigen::Matrix3d::Identity(), {0, 0, 0})), "pose-invalid");
  EXPECT_EQ(error(shift({1, 2, 3})), "none");
}

TEST(QuantizedPose, RefusesWhatDoesNotFit) {
  const auto error = [](const Lattice& fixed, const Lattice& moving, const Eigen::Vector3d& by) {
    return error_of([&] { static_cast<void>(quantize_pose(shift(by), fixed, moving)); });
  };
  const auto code = [&](const Lattice& fixed, const Lattice& moving,
                        const Eigen::Vector3d& by = {0, 0, 0}) {
    const auto found = error(fixed, moving, by);
    return std::string(found ? to_string(found->code()) : "none");
  };
  const Lattice lattice = centred_lattice(4);
  // Voxels 8 times as large, and what rounds to that.
  EXPECT_EQ(code(lattice, centred_lattice(4, 12 * 7.9999)), "none");
  EXPECT_EQ(code(lattice, centred_lattice(4, 12 * 8)), "fixed-point-range");
  EXPECT_EQ(code(lattice, centred_lattice(4, std::nextafter(12.0 * 8, 0))), "fixed-point-range");
  EXPECT_EQ(code(lattice, centred_lattice(4, 1200)), "fixed-point-range");
  EXPECT_NE(std::string(error(lattice, centred_lattice(4, 96), {0, 0, 0})->what())
                .find("let the body with the larger voxels be the fixed one"),
            std::string::npos);
  EXPECT_EQ(code(centred_lattice(4, 96), lattice), "none");
  // Centres beyond 2²³ units: the moving root's half edge is 96 units.
  const double most = 8388608 - 96;
  EXPECT_EQ(code(lattice, lattice, {most - 1, 0, 0}), "none");
  EXPECT_EQ(code(lattice, lattice, {0, -most, 0}), "fixed-point-range");
  EXPECT_EQ(code(lattice, lattice, {0, 0, 1e9}), "fixed-point-range");
  EXPECT_EQ(code(lattice, lattice, {0, 0, 1e300}), "fixed-point-range");
  EXPECT_EQ(code(lattice, lattice, {1.7e308, 0, 0}), "fixed-point-range");
  // A place whose doubles are lost in rounding: then in the pad, or no pad holds them.
  Lattice far = lattice;
  far.corner = {1e27, 1e27, 1e27};
  EXPECT_EQ(code(far, far), "none");
  EXPECT_GT(quantize_pose(shift({0, 0, 0}), far, far).registers.pad, 4);
  far.corner = {1e32, 1e32, 1e32};
  EXPECT_EQ(code(far, far), "fixed-point-range");
}

}  // namespace
}  // namespace ist::test
