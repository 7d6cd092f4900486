#pragma once

#include <cstring>
#include <memory>
#include <vector>

#include "simd/guarded.h"
#include "simd/pair_cache_step.h"

namespace ist::test {

/// A cache in guarded memory.
class GuardedCache : public CacheLanes {
 public:
  GuardedCache(std::size_t rows, std::size_t pairs) : CacheLanes{} {
    row_capacity = rows;
    pair_capacity = pairs;
    for (float*& lane : moving.lane) lane = floats(pairs);
    for (float** of :
         {&moving.x, &moving.y, &moving.z, &moving.normal_x, &moving.normal_y, &moving.normal_z}) {
      *of = floats(pairs);
    }
    moving.id = numbers(pairs);
    moving.row = numbers(pairs);
    for (float*& lane : fixed.lane) lane = floats(rows);
    for (float** of : {&fixed.normal_x, &fixed.normal_y, &fixed.normal_z}) *of = floats(rows);
    fixed.id = numbers(rows);
    fixed.address = numbers(rows);
  }
  /// Whether nothing was written in front of the arrays, nor behind them and what is to spare.
  [[nodiscard]] bool intact() const {
    const auto whole = [](const auto& array) { return array->intact(); };
    return std::all_of(floats_.begin(), floats_.end(), whole) &&
           std::all_of(numbers_.begin(), numbers_.end(), whole);
  }

 private:
  float* floats(std::size_t count) {
    floats_.push_back(std::make_unique<Guarded<float>>(count + kCacheSpare, 0));
    return floats_.back()->data();
  }
  std::uint32_t* numbers(std::size_t count) {
    numbers_.push_back(std::make_unique<Guarded<std::uint32_t>>(count + kCacheSpare, 0));
    return numbers_.back()->data();
  }

  std::vector<std::unique_ptr<Guarded<float>>> floats_;
  std::vector<std::unique_ptr<Guarded<std::uint32_t>>> numbers_;
};

/// The rows of a cache in guarded memory.
class GuardedRows : public CacheRows {
 public:
  explicit GuardedRows(std::size_t rows) : CacheRows{} {
    for (float** of : arrays()) {
      memory_.push_back(std::make_unique<Guarded<float>>(rows + kCacheSpare, 0));
      *of = memory_.back()->data();
    }
  }
  [[nodiscard]] bool intact() const {
    return std::all_of(memory_.begin(), memory_.end(), [](const auto& m) { return m->intact(); });
  }
  /// Whether the first `count` rows are the same bits; the surfaces too, if so wanted.
  [[nodiscard]] bool same(GuardedRows& other, std::size_t count, bool slabs, bool surfaces) {
    const auto mine = arrays(), others = other.arrays();
    for (std::size_t i = 0; i < mine.size(); ++i) {
      const bool of_slab = i >= 4 && i < kSurface;
      if ((of_slab && !slabs) || (i >= kSurface && !surfaces)) continue;
      if (std::memcmp(*mine[i], *others[i], count * sizeof(float)) != 0) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kSurface = 10;
  std::vector<float**> arrays() {
    return {&x,
            &y,
            &z,
            &radius,
            &normal_x,
            &normal_y,
            &normal_z,
            &offset,
            &half,
            &scaled_radius,
            &surface.x,
            &surface.y,
            &surface.z,
            &surface.normal_x,
            &surface.normal_y,
            &surface.normal_z};
  }

  std::vector<std::unique_ptr<Guarded<float>>> memory_;
};

/// Whether two caches hold the same pairs, float for float.
[[nodiscard]] inline bool same_cache(const CacheLanes& a, const CacheLanes& b, bool slabs) {
  if (a.row_count != b.row_count || a.pair_count != b.pair_count) return false;
  const auto same = [](const auto* p, const auto* q, std::size_t count) {
    return std::memcmp(p, q, count * sizeof *p) == 0;
  };
  bool all = true;
  for (std::size_t lane = 0; lane < (slabs ? kLanes : kNormalX); ++lane) {
    all &= same(a.fixed.lane[lane], b.fixed.lane[lane], a.row_count) &&
           same(a.moving.lane[lane], b.moving.lane[lane], a.pair_count);
  }
  const CacheLanes::Moving &m = a.moving, &n = b.moving;
  const CacheLanes::Fixed &f = a.fixed, &g = b.fixed;
  for (const auto& [p, q] : {std::pair{m.x, n.x},
                             {m.y, n.y},
                             {m.z, n.z},
                             {m.normal_x, n.normal_x},
                             {m.normal_y, n.normal_y},
                             {m.normal_z, n.normal_z}}) {
    all &= same(p, q, a.pair_count);
  }
  for (const auto& [p, q] :
       {std::pair{f.normal_x, g.normal_x}, {f.normal_y, g.normal_y}, {f.normal_z, g.normal_z}}) {
    all &= same(p, q, a.row_count);
  }
  return all && same(m.id, n.id, a.pair_count) && same(m.row, n.row, a.pair_count) &&
         same(f.id, g.id, a.row_count) && same(f.address, g.address, a.row_count);
}

}  // namespace ist::test
