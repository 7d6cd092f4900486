#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "ist/query/world/world.h"

namespace ist {

/// The place of each pair's query, of all pairs of some bodies.
class PairTable {
 public:
  static constexpr std::uint32_t kNoQuery = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kIgnored = kNoQuery - 1;

  /// Adds a body, whose pairs with all others have no query.
  void add() {
    places_.insert(places_.end(), bodies_, kNoQuery);
    ++bodies_;
  }
  /// Precondition: a < b < the number of bodies.
  [[nodiscard]] std::uint32_t& operator[](BodyPair pair) noexcept { return places_[at(pair)]; }
  [[nodiscard]] std::uint32_t operator[](BodyPair pair) const noexcept { return places_[at(pair)]; }
  /// Takes all queries out.
  void clear() noexcept {
    std::replace_if(
        places_.begin(), places_.end(), [](auto at) { return at < kIgnored; }, kNoQuery);
  }
  /// Returns the number of all pairs, ignored or not.
  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }

 private:
  static std::size_t at(BodyPair pair) noexcept {
    return std::size_t{pair.b} * (pair.b - 1) / 2 + pair.a;
  }
  std::vector<std::uint32_t> places_;
  std::size_t bodies_ = 0;
};

}  // namespace ist
