#include "ist/voxel/morton.h"

#include <gtest/gtest.h>

#include "support/effort.h"
#include "support/random.h"

namespace ist {
namespace {

// Bit by bit, as the definition has it.
std::uint64_t interleaved(const Cell& cell) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < 16; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      code |= std::uint64_t{cell[axis] >> bit & 1} << (3 * bit + axis);
    }
  }
  return code;
}

TEST(Morton, EveryIndexOfEachAxisGoesThereAndBack) {
  for (std::uint32_t i = 0; i < 1u << 16; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Cell cell{0xFFFF, 0xFFFF, 0xFFFF};
      cell[axis] = i;
      const std::uint64_t code = morton_encode(cell);
      ASSERT_EQ(code, interleaved(cell));
      ASSERT_EQ(morton_decode(code), cell);
    }
  }
}

TEST(Morton, RandomCellsGoThereAndBack) {
  test::Random random(1);
  for (int i = 0; i < test::samples(100'000); ++i) {
    const Cell cell{random.below(1u << 16), random.below(1u << 16), random.below(1u << 16)};
    ASSERT_EQ(morton_encode(cell), interleaved(cell));
    ASSERT_EQ(morton_decode(morton_encode(cell)), cell);
  }
}

TEST(Morton, OctantsCountXFirstThenYThenZ) {
  EXPECT_EQ(morton_encode({1, 0, 0}), 1u);
  EXPECT_EQ(morton_encode({0, 1, 0}), 2u);
  EXPECT_EQ(morton_encode({0, 0, 1}), 4u);
  EXPECT_EQ(morton_encode({0xFFFF, 0xFFFF, 0xFFFF}), (std::uint64_t{1} << 48) - 1);
}

TEST(Morton, TheParentsCodeIsTheCodeWithoutTheOctant) {
  test::Random random(2);
  for (int i = 0; i < test::samples(1000); ++i) {
    const Cell cell{random.below(1u << 16), random.below(1u << 16), random.below(1u << 16)};
    EXPECT_EQ(morton_encode(cell) >> 3, morton_encode({cell[0] / 2, cell[1] / 2, cell[2] / 2}));
    EXPECT_EQ(morton_encode(cell) & 7, cell[0] % 2 + 2 * (cell[1] % 2) + 4 * (cell[2] % 2));
  }
}

}  // namespace
}  // namespace ist
