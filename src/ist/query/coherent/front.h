#pragma once

#include <cstddef>
#include <vector>

#include "ist/query/relative_pose.h"
#include "simd/front_step.h"

namespace ist {

struct alignas(64) FrontLine {
  std::byte bytes[64];
};

/// Leaf pairs kept from one pose to the next, and the poses at which no others can overlap.
class Front {
 public:
  /// Reserves all memory: 68 bytes each for `pairs`, and 56 for half as many rows.
  explicit Front(std::size_t pairs);
  Front(const Front&) = delete;
  Front& operator=(const Front&) = delete;

  FrontLanes lanes{};
  RelativePose centre{};
  /// Every pair of leaves whose bounds are no farther than this apart at `centre`, mesh units, is
  /// in the front.
  double extent = 0;
  /// Bounds the distance between the surfaces at `centre`, mesh units; infinite where that was not
  /// measured.
  double upper = 0;

  [[nodiscard]] bool empty() const noexcept { return lanes.pair_count == 0; }
  /// Returns the bytes that a front with room for `pairs` reserves.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<FrontLine> memory_;
};

/// The rows of a front at one pose.
class FrontRowMemory {
 public:
  /// Reserves 64 bytes for each row of a front with room for `pairs`.
  explicit FrontRowMemory(std::size_t pairs);

  [[nodiscard]] FrontRows& rows() noexcept { return rows_; }
  /// Returns the bytes that the rows of a front with room for `pairs` reserve.
  [[nodiscard]] static std::size_t bytes_for(std::size_t pairs) noexcept;

 private:
  std::vector<FrontLine> memory_;
  FrontRows rows_{};
};

}  // namespace ist
