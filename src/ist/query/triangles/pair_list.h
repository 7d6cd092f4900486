#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/results.h"

namespace ist {

/// Pairs of triangles for a caller's span, which may be too short: then the first pairs by their
/// order are kept.
class PairList {
 public:
  /// Reserves memory to sort up to `scratch` pairs fast, 8 bytes each.
  explicit PairList(std::size_t scratch) : scratch_(scratch) {}

  void begin(std::span<TrianglePair> out) noexcept;
  void add(TrianglePair pair) noexcept;
  /// Sorts the pairs in the span.
  void finish() noexcept;
  /// Returns the number of pairs that were added, in the span or not.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  std::span<TrianglePair> out_;
  std::uint64_t count_ = 0;
  std::vector<TrianglePair> scratch_;
};

}  // namespace ist
