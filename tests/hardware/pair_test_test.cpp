#include "ist/hardware/pair_test.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "hardware/golden_vectors.h"
#include "ist/hardware/table_rom.h"
#include "ist/tree/lookup_table.h"
#include "support/effort.h"
#include "support/exact.h"

namespace ist::test {
namespace {

mpz_class power(unsigned exponent) { return mpz_class(1) << exponent; }

mpz_class ceil_of(const mpq_class& x) { return -floor_of(-x); }

// The smallest whole number whose square is no less.
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

// What the README guarantees of widths, at the registers' ends.
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

}  // namespace
}  // namespace ist::test
