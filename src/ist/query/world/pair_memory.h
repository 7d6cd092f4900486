#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "ist/query/triangles/triangle_search.h"
#include "ist/query/world/body_pose.h"
#include "ist/query/world/world.h"

namespace ist {

/// The memory of a pair of bodies from question to question.
struct PairMemory {
  static constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

  BodyPair bodies{};
  Witnesses witnesses{};
  BodyPose pose{};               ///< at the last question about leaf pairs
  std::uint64_t leaf_tick = 0;   ///< the number of that question; 0 if there was none
  std::uint32_t slot = kNoSlot;  ///< the place of its pair cache, if that is still the pair's
};

/// The memories of the pairs of the last question, in the order of BodyPair.
class PairMemories {
 public:
  PairMemories() = default;
  /// Reserves all memory.
  explicit PairMemories(std::size_t room) {
    pairs_.reserve(room);
    before_.reserve(room);
  }

  /// Keeps these pairs, and begins with new ones. `bodies_at(k)` returns pair k, in ascending
  /// order. Precondition: there is room.
  template <class BodiesAt>
  void keep(std::size_t count, BodiesAt bodies_at) noexcept {
    std::swap(pairs_, before_);
    pairs_.clear();
    auto old = before_.begin();
    for (std::size_t k = 0; k < count; ++k) {
      const BodyPair bodies = bodies_at(k);
      while (old != before_.end() && old->bodies < bodies) ++old;
      if (old != before_.end() && old->bodies == bodies) {
        pairs_.push_back(*old);
      } else {
        pairs_.push_back({.bodies = bodies});
      }
    }
  }
  void clear() noexcept { pairs_.clear(); }

  [[nodiscard]] PairMemory& operator[](std::size_t k) noexcept { return pairs_[k]; }
  /// Returns the place of a pair that is kept.
  [[nodiscard]] std::size_t place_of(BodyPair bodies) const noexcept {
    const auto at = std::lower_bound(
        pairs_.begin(), pairs_.end(), bodies,
        [](const PairMemory& memory, BodyPair wanted) { return memory.bodies < wanted; });
    return static_cast<std::size_t>(at - pairs_.begin());
  }
  /// Returns the bytes for so many pairs.
  [[nodiscard]] static constexpr std::uint64_t bytes_for(std::size_t room) noexcept {
    return std::uint64_t{room} * 2 * sizeof(PairMemory);
  }

 private:
  std::vector<PairMemory> pairs_, before_;
};

}  // namespace ist
