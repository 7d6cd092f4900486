#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "ablation/variant.h"
#include "support/bodies.h"
#include "support/latencies.h"

namespace ist::bench {

inline constexpr std::size_t kPoses = std::size(kClosing);

/// A variant, and what it was seen to take and to give, by pose of kClosing.
struct Measured {
  Parts parts;
  Variant variant;
  std::array<Latencies, kPoses> latencies{};
  std::array<QueryResult, kPoses> results{};
  std::int64_t rounds = 0;  ///< times that each pose was timed
};

/// Measures variants beside each other in turns, so that what else the machine does meets them all:
/// in each round every variant has one turn, in which it is asked the whole closing again and
/// again, so that no pose is asked twice in a row.
class Comparison {
 public:
  /// Of the bodies' trees of this voxel size, mesh units. Parts named twice are measured once.
  Comparison(double voxel_size, const std::vector<Parts>& parts);
  Comparison(const Comparison&) = delete;  // its variants refer to its bodies
  Comparison& operator=(const Comparison&) = delete;

  /// Ends the program where a variant's answer to any pose is not what it must be: with pointers
  /// that of ReferenceQuery, contacts, order and tests; in batches that of one worker without SIMD,
  /// as exactly; and those two, which may differ in pairs whose geometry does not meet, keep what
  /// AnswerVerifier asks of both; where quick() that is checked in full occlusion alone. A time of
  /// a wrong answer would mean nothing.
  void check();

  /// A turn begins with closings that are not timed, so that caches hold what the variant reads and
  /// the second worker has noticed that it is asked again: it looks every 10 ms. Ends the program
  /// where a timed query counts other contacts or tests than check() saw.
  void measure(int rounds);

  /// Precondition: these parts were named.
  [[nodiscard]] Measured& of(const Parts& parts);

 private:
  void check(SpherePolicy policy);
  void take_turn(Measured& measured);

  Bodies bodies_;
  std::deque<Measured> measured_;
  std::vector<LeafPair> leaf_pairs_;
};

}  // namespace ist::bench
