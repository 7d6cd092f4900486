#include "ist/query/pair_cache/pair_cache.h"

#include <initializer_list>

namespace ist {
namespace {

static_assert(sizeof(float) == sizeof(std::uint32_t));

std::size_t row_capacity(std::size_t pairs) noexcept { return pairs / 2 + 1; }

// The bytes of an array of numbers of 32 bits, in whole lines.
std::size_t array_bytes(std::size_t count) noexcept { return (count + kCacheSpare + 15) / 16 * 64; }

// Hands out arrays, one behind the other.
class Arrays {
 public:
  explicit Arrays(void* memory) : next_(static_cast<std::byte*>(memory)) {}

  template <class T>
  void give(std::size_t count, std::initializer_list<T**> arrays) {
    for (T** array : arrays) {
      *array = reinterpret_cast<T*>(next_);
      next_ += array_bytes(count);
    }
  }
  void give_lanes(std::size_t count, float* (&lanes)[kLanes]) {
    for (float*& lane : lanes) give(count, {&lane});
  }

 private:
  std::byte* next_;
};

}  // namespace

std::size_t PairCache::bytes_for(std::size_t pairs) noexcept {
  return (kLanes + 8) * array_bytes(pairs) + (kLanes + 5) * array_bytes(row_capacity(pairs));
}

PairCache::PairCache(std::size_t pairs) : memory_(bytes_for(pairs) / sizeof(MemoryLine)) {
  lanes.pair_capacity = pairs;
  lanes.row_capacity = row_capacity(pairs);
  Arrays arrays(memory_.data());
  CacheLanes::Moving& m = lanes.moving;
  arrays.give_lanes(pairs, m.lane);
  arrays.give(pairs, {&m.x, &m.y, &m.z, &m.normal_x, &m.normal_y, &m.normal_z});
  arrays.give(pairs, {&m.id, &m.row});
  CacheLanes::Fixed& f = lanes.fixed;
  arrays.give_lanes(lanes.row_capacity, f.lane);
  arrays.give(lanes.row_capacity, {&f.normal_x, &f.normal_y, &f.normal_z});
  arrays.give(lanes.row_capacity, {&f.id, &f.address});
}

std::size_t CacheRowMemory::bytes_for(std::size_t pairs) noexcept {
  return 16 * array_bytes(row_capacity(pairs));
}

CacheRowMemory::CacheRowMemory(std::size_t pairs) : memory_(bytes_for(pairs) / sizeof(MemoryLine)) {
  Arrays arrays(memory_.data());
  CacheRows::Surface& on = rows_.surface;
  arrays.give(row_capacity(pairs),
              {&rows_.x, &rows_.y, &rows_.z, &rows_.radius, &rows_.normal_x, &rows_.normal_y,
               &rows_.normal_z, &rows_.offset, &rows_.half, &rows_.scaled_radius, &on.x, &on.y,
               &on.z, &on.normal_x, &on.normal_y, &on.normal_z});
}

}  // namespace ist
