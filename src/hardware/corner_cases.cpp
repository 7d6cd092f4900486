#include <array>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "hardware/golden_vectors.h"
#include "ist/hardware/quantized_pose.h"
#include "ist/hardware/table_rom.h"

namespace ist {
namespace {

using Distance = std::array<std::int64_t, 3>;
using Bytes = std::initializer_list<std::uint8_t>;
using Words = std::initializer_list<std::uint16_t>;

constexpr std::int32_t kMostRotation = (1 << 19) - 1, kLeastRotation = -(1 << 19);

// Returns two full nodes, with voxels of one size and no rotation.
GoldenVector plain_vector() {
  GoldenVector vector;
  vector.pair.fixed_mask = vector.pair.moving_mask = 255;
  vector.pair.fixed_level = vector.pair.moving_level = 3;
  vector.registers = make_registers(Eigen::Matrix3d::Identity(), 1, 5);
  return vector;
}

// A rotation register that permutes the axes, with no two nonzero entries equal.
constexpr std::array<std::int32_t, 9> kTurned = {0, 81920, 3, -70001, 0, -5, 7, 11, 65537};

class Corners {
 public:
  std::vector<GoldenVector> take() { return std::move(vectors_); }

  void add(const GoldenVector& vector) { vectors_.push_back(answered(vector)); }
  void add_at(const GoldenVector& vector, const Distance& distance) {
    if (const auto placed = at_distance(vector, distance)) vectors_.push_back(*placed);
  }

  // Adds tangent balls, and one step to either side of tangency, along each axis in both
  // directions.
  void add_touching(const GoldenVector& vector) {
    const auto reach = static_cast<std::int64_t>(test_pair(vector.pair, vector.registers).reach);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int sign : {1, -1}) {
        for (const int beyond : {-1, 0, 1}) {
          Distance distance{};
          distance[axis] = sign * (reach + beyond);
          add_at(vector, distance);
        }
      }
    }
  }

 private:
  std::vector<GoldenVector> vectors_;
};

// Sets the moving level, radius and pad such that the reach is `reach`.
GoldenVector with_reach(GoldenVector vector, std::uint64_t reach) {
  vector.pair.fixed_level = 0;
  const std::uint64_t left =
      reach - kFixedRadii[rom_radius_code(table_rom()[vector.pair.fixed_mask])];
  int level = 0;
  while (left >> level > 0xFFFF) ++level;
  vector.pair.moving_level = static_cast<std::uint8_t>(level);
  vector.registers.radius.fill(static_cast<std::uint16_t>(left >> level));
  vector.registers.pad = static_cast<std::uint16_t>(left & ((std::uint64_t{1} << level) - 1));
  return vector;
}

void add_empty(Corners& corners) {
  for (const int fixed_mask : {0, 255}) {
    for (const int moving_mask : {0, 255}) {
      GoldenVector vector = plain_vector();
      vector.pair.fixed_mask = static_cast<std::uint8_t>(fixed_mask);
      vector.pair.moving_mask = static_cast<std::uint8_t>(moving_mask);
      corners.add_at(vector, {0, 0, 0});
      corners.add_touching(vector);
    }
  }
}

void add_levels(Corners& corners) {
  for (const std::uint8_t fixed_level : Bytes{0, 1, 7, 8, 9, 15, 16}) {
    for (const std::uint8_t moving_level : Bytes{0, 1, 7, 8, 9, 15, 16}) {
      GoldenVector vector = plain_vector();
      vector.registers.rotation = kTurned;
      vector.pair.fixed_mask = 0x08;
      vector.pair.moving_mask = 0x20;
      vector.pair.fixed_level = fixed_level;
      vector.pair.moving_level = moving_level;
      corners.add_touching(vector);
    }
  }
}

// Adds each mask at a distance at which its own offset and radius decide.
void add_masks(Corners& corners) {
  for (int mask = 0; mask < 256; ++mask) {
    for (const bool moving : {false, true}) {
      GoldenVector vector = plain_vector();
      vector.registers.rotation = kTurned;
      (moving ? vector.pair.moving_mask : vector.pair.fixed_mask) = static_cast<std::uint8_t>(mask);
      const auto reach = static_cast<std::int64_t>(test_pair(vector.pair, vector.registers).reach);
      corners.add_at(vector, {reach, 0, 0});
      corners.add_at(vector, {0, 0, -reach - 1});
    }
  }
}

void add_extreme_coordinates(Corners& corners) {
  using Limits = std::numeric_limits<std::int32_t>;
  for (int signs = 0; signs < 64; ++signs) {
    for (const std::int32_t turn : {kMostRotation, kLeastRotation}) {
      GoldenVector vector = plain_vector();
      vector.registers.rotation.fill(turn);
      vector.pair.fixed_level = vector.pair.moving_level = kMaxNodeLevel;
      // Masks of a single corner child, whose ball lies farthest out.
      vector.pair.fixed_mask = static_cast<std::uint8_t>(1 << (signs & 7));
      vector.pair.moving_mask = static_cast<std::uint8_t>(1 << (signs >> 3));
      for (std::size_t i = 0; i < 3; ++i) {
        vector.pair.fixed_centre[i] = (signs >> i & 1) != 0 ? kMaxCentre : -kMaxCentre;
        vector.pair.moving_centre[i] = (signs >> (3 + i) & 1) != 0 ? Limits::max() : Limits::min();
      }
      corners.add(vector);
      vector.registers.radius.fill(0xFFFF);
      vector.registers.pad = 0xFFFF;
      corners.add(vector);
    }
  }
}

void add_extreme_registers(Corners& corners) {
  for (const std::int32_t turn : {kMostRotation, kLeastRotation, 0, 1, -1}) {
    for (const std::uint8_t mask : Bytes{0x01, 0x80, 0x24, 0x0F, 0xFF}) {
      for (const std::uint8_t level : Bytes{0, 16}) {
        GoldenVector vector = plain_vector();
        vector.registers.rotation.fill(turn);
        vector.pair.moving_mask = mask;
        vector.pair.moving_level = level;
        corners.add_touching(vector);
      }
    }
  }
  for (const std::uint16_t pad : Words{0x0000, 0x0001, 0x7FFF, 0x8000, 0xFFFF}) {
    for (const std::uint16_t radius : Words{0x0000, 0x0001, 0x8000, 0xFFFF}) {
      GoldenVector vector = plain_vector();
      vector.registers.pad = pad;
      vector.registers.radius.fill(radius);
      corners.add_touching(vector);
    }
  }
}

// Adds reaches that lose one bit more each, along the axes; and on the sphere, where the squares
// are equal to the last bit: 1² + 2² + 2² = 3² and 2² + 3² + 6² = 7².
void add_reaches(Corners& corners) {
  for (int bits = 12; bits <= 32; ++bits) {
    for (const int more : {-1, 0, 1}) {
      const std::uint64_t reach = (std::uint64_t{1} << bits) + static_cast<std::uint64_t>(more);
      corners.add_touching(with_reach(plain_vector(), reach));
    }
  }
  constexpr std::int64_t kLongest = 3 * 7 * 1000;
  for (int cut = 0; cut <= 17; ++cut) {
    const std::int64_t lost = (std::int64_t{1} << cut) - 1;  // largest value that is cut off
    for (const std::int64_t more : {-lost, std::int64_t{0}, std::int64_t{1}}) {
      const GoldenVector vector =
          with_reach(plain_vector(), static_cast<std::uint64_t>((kLongest << cut) + more));
      for (const auto& [x, y, z] : {Distance{7000, 14000, 14000}, Distance{-18000, 6000, -9000}}) {
        corners.add_at(vector, {x << cut, y << cut, z << cut});
        corners.add_at(vector, {(std::abs(x) << cut) + lost, -(std::abs(y) << cut) - lost,
                                (std::abs(z) << cut) + lost});
        corners.add_at(vector, {x << cut, y << cut, (z + (z > 0 ? 1 : -1)) << cut});
      }
    }
  }
  GoldenVector largest = plain_vector();
  largest.pair.fixed_level = largest.pair.moving_level = kMaxNodeLevel;
  largest.registers.radius.fill(0xFFFF);
  largest.registers.pad = 0xFFFF;
  corners.add(largest);
  corners.add_at(largest, {std::int64_t{1} << 31, std::int64_t{1} << 31, std::int64_t{1} << 31});
}

}  // namespace

std::vector<GoldenVector> corner_cases() {
  Corners corners;
  add_empty(corners);
  add_levels(corners);
  add_masks(corners);
  add_extreme_coordinates(corners);
  add_extreme_registers(corners);
  add_reaches(corners);
  return corners.take();
}

}  // namespace ist
