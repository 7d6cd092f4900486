#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "simd/triangles/cluster_step.h"

/// The test of two nodes, lane by lane, in the order of operations that every vector form keeps.
namespace ist {

[[nodiscard]] inline float dot(const float (&a)[3], const float (&b)[3]) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/// Returns the sine of an angle by its cosine, which is rounded: no less than it is.
[[nodiscard]] inline float sine_of(float cosine) noexcept {
  return std::sqrt(std::max(0.0F, (1 + kSineRounding) - cosine * cosine));
}

/// One node's bounds.
struct NodeLane {
  float centre[3], rest[3], low[3], high[3], normal[3], offset, thickness, rim, radius;

  template <class Block>
  NodeLane(const Block& block, std::size_t lane) noexcept
      : offset(block.offset[lane]),
        thickness(block.thickness[lane]),
        rim(block.rim[lane]),
        radius(block.radius[lane]) {
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] = block.centre[i][lane];
      normal[i] = block.normal[i][lane];
      if constexpr (std::is_same_v<Block, TurnedBlock>) {
        rest[i] = block.rest[i][lane];
        low[i] = block.low[i][lane];
        high[i] = block.high[i][lane];
      } else {
        rest[i] = 0;
        low[i] = -block.half[i][lane];
        high[i] = block.half[i][lane];
      }
    }
  }
};

/// Where one node's centre and box are from another's.
struct NodesApart {
  float centre[3], gap[3];

  NodesApart(const NodeLane& one, const NodeLane& other) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] = (one.centre[i] - other.centre[i]) + (one.rest[i] - other.rest[i]);
      gap[i] = std::max(std::max((centre[i] + one.low[i]) - other.high[i],
                                 other.low[i] - (centre[i] + one.high[i])),
                        0.0F);
    }
  }
};

/// Returns whether two nodes may be within `reach` of each other: neither their boxes are farther
/// apart, nor is one disc from the plane of the other.
[[nodiscard]] inline bool may_be_near(const NodeLane& one, const NodeLane& other,
                                      float reach) noexcept {
  const float most = reach + ((one.radius + other.radius) + reach) * kNodeRounding;
  const NodesApart apart(one, other);
  if (dot(apart.gap, apart.gap) > most * most + kSquareUnderflow) return false;
  const float cosine = dot(other.normal, one.normal);
  const float size = std::abs(cosine), sine = sine_of(cosine);
  const float from_other = (dot(other.normal, apart.centre) + cosine * one.offset) - other.offset;
  const float from_one = (cosine * other.offset - dot(one.normal, apart.centre)) - one.offset;
  return !(std::abs(from_other) >
           ((other.thickness + size * one.thickness) + sine * one.rim) + most) &&
         !(std::abs(from_one) >
           ((one.thickness + size * other.thickness) + sine * other.rim) + most);
}

}  // namespace ist
