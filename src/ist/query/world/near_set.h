#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ist/query/world/body_pose.h"
#include "ist/query/world/world.h"

namespace ist {

/// A pair of bodies at their poses, for the world's own use.
struct PairAtPose {
  BodyPair bodies;
  QueryStatus status;      ///< as WorldPair has it before the pair is asked
  DistanceInterval roots;  ///< as WorldPair has it
  bool overlap;            ///< the roots are no farther apart than they need be to be near
  std::uint32_t place;     ///< of its query; PairTable::kNoQuery without one
  BodyPose pose;           ///< of the later body in the first one's coordinates
};

/// The pairs that are near, in bounded memory: where there is no room for all, those with a query
/// come before those without, and then the first by BodyPair. So it does not matter in which order
/// pairs are found.
class NearSet {
 public:
  NearSet() = default;
  /// Reserves memory for so many pairs.
  explicit NearSet(std::size_t room) : room_(room) {
    pairs_.reserve(room);
    order_.reserve(room);
  }

  void clear() noexcept;
  void add(const PairAtPose& pair) noexcept;
  /// Ends the additions: sorts.
  void finish() noexcept;

  /// Returns the number of pairs added.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Returns the number of pairs kept.
  [[nodiscard]] std::size_t size() const noexcept { return order_.size(); }
  [[nodiscard]] const PairAtPose& operator[](std::size_t k) const noexcept {
    return pairs_[order_[k].at];
  }

 private:
  struct Entry {
    bool prepared;
    BodyPair bodies;
    std::uint32_t at;
  };
  static bool is_before(const Entry& a, const Entry& b) noexcept;

  std::size_t room_ = 0;
  std::vector<PairAtPose> pairs_;
  std::vector<Entry> order_;  // while full a heap, with the last one on top
  std::uint64_t count_ = 0;
};

}  // namespace ist
