#include "ist/mesh/format/weld.h"

#include <bit>
#include <limits>

#include "ist/base/assert.h"

namespace ist {
namespace {

constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

std::uint64_t hash(const std::array<float, 3>& point) {
  std::uint64_t h = 0;
  for (const float coordinate : point) {
    h = (h ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9E3779B97F4A7C15u;
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

Welder::Welder(std::size_t points) : slots_(std::bit_ceil(2 * points + 1), kFree) {}

std::uint32_t Welder::index_of(std::array<float, 3> point) {
  for (float& coordinate : point) coordinate += 0.0f;  // turns -0 into 0
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(point) & mask;
  while (slots_[slot] != kFree && points_[slots_[slot]] != point) slot = (slot + 1) & mask;
  if (slots_[slot] == kFree) {
    IST_ASSERT(points_.size() < kFree && 2 * points_.size() < slots_.size());
    slots_[slot] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    vertices_.emplace_back(point[0], point[1], point[2]);
  }
  return slots_[slot];
}

}  // namespace ist
