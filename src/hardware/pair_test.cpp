#include "ist/hardware/pair_test.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "ist/base/assert.h"
#include "ist/hardware/table_rom.h"

namespace ist {
namespace {

constexpr int kFraction = 8;      // bits after the point of a distance
constexpr int kRotation = 16;     // bits after the point of the rotation
constexpr int kSquaredBits = 15;  // squared values are at most 2^15

// Returns the radius of a word, 0 for a code above 4, which mask 0 alone has.
std::uint64_t radius_of(const std::array<std::uint16_t, 5>& radii, std::uint16_t word) noexcept {
  const unsigned code = rom_radius_code(word);
  return code < radii.size() ? radii[code] : 0;
}

}  // namespace

std::array<std::int64_t, 3> ball_distance(const NodePair& pair,
                                          const PairRegisters& registers) noexcept {
  const std::uint16_t fixed = table_rom()[pair.fixed_mask], moving = table_rom()[pair.moving_mask];
  std::array<std::int64_t, 3> distance{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t turned = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      turned += std::int64_t{rom_coordinate(moving, k)} * registers.rotation[3 * k + i];
    }
    const std::int64_t moving_offset = (turned << pair.moving_level) >> (kRotation - kFraction);
    const std::int64_t fixed_offset = std::int64_t{rom_coordinate(fixed, i)} << pair.fixed_level;
    distance[i] = (pair.moving_centre[i] + moving_offset) -
                  ((pair.fixed_centre[i] + fixed_offset) << kFraction);
  }
  return distance;
}

PairAnswer test_pair(const NodePair& pair, const PairRegisters& registers) noexcept {
  IST_ASSERT(pair.fixed_level <= kMaxNodeLevel && pair.moving_level <= kMaxNodeLevel);
  const std::uint16_t fixed = table_rom()[pair.fixed_mask], moving = table_rom()[pair.moving_mask];
  PairAnswer answer;
  answer.reach = (radius_of(kFixedRadii, fixed) << pair.fixed_level) +
                 (radius_of(registers.radius, moving) << pair.moving_level) + registers.pad;

  std::array<std::uint64_t, 3> along{};
  const std::array<std::int64_t, 3> distance = ball_distance(pair, registers);
  for (std::size_t i = 0; i < 3; ++i) {
    along[i] = static_cast<std::uint64_t>(std::abs(distance[i]));
    if (along[i] > answer.reach) return answer;
  }
  // Cut bits shorten the distance and lengthen the reach, never the other way.
  const int cut = std::max(0, static_cast<int>(std::bit_width(answer.reach)) - kSquaredBits);
  const std::uint64_t longest = (answer.reach + ((std::uint64_t{1} << cut) - 1)) >> cut;
  std::uint64_t squared = 0;
  for (const std::uint64_t d : along) squared += (d >> cut) * (d >> cut);
  answer.hit = squared <= longest * longest && pair.fixed_mask != 0 && pair.moving_mask != 0;
  return answer;
}

}  // namespace ist
