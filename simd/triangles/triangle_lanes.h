#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "simd/triangles/cluster_step.h"

/// The comparison of two triangles in float, lane by lane. Vector forms may fuse products to sums:
/// the bounds of the errors cover both. The test of two nodes comes first: every vector form keeps
/// the order of its operations.
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

using LanePoint = std::array<float, 3>;
using LaneTriangle = std::array<LanePoint, 3>;

[[nodiscard]] inline LanePoint operator-(const LanePoint& a, const LanePoint& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline float dot(const LanePoint& a, const LanePoint& b) noexcept {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
[[nodiscard]] inline LanePoint cross(const LanePoint& a, const LanePoint& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Returns the sum of the absolute coordinates.
[[nodiscard]] inline float size(const LanePoint& a) noexcept {
  return (std::abs(a[0]) + std::abs(a[1])) + std::abs(a[2]);
}

/// Returns the error, in a fixed cluster's frame, of a difference of any two coordinates: of
/// clusters of these radii whose centres are `apart`, the sum of its absolute coordinates
/// (docs/guarantees.md, Triangles decided in float).
[[nodiscard]] inline float difference_error(float fixed_radius, float moving_radius, float apart,
                                            float pose_error) noexcept {
  return 0x1p-21F * ((fixed_radius + 4 * moving_radius) + apart) + pose_error;
}

/// The triangles of a moving cluster in the frame of a fixed one.
class ClusterPlace {
 public:
  ClusterPlace(const ClusterStep& step, const NodeLane& moving_node, std::uint32_t moving,
               std::uint32_t fixed, const NodeLane& fixed_node) noexcept
      : fixed_(step.fixed[fixed]),
        moving_(step.moving[moving]),
        fixed_count_(count_of(step.fixed_triangles, fixed)),
        moving_count_(count_of(step.moving_triangles, moving)) {
    const NodesApart nodes(moving_node, fixed_node);
    const LanePoint apart = {nodes.centre[0], nodes.centre[1], nodes.centre[2]};
    error_ = difference_error(fixed_node.radius, moving_node.radius, size(apart), step.pose.error);
    LanePoint axis[3];  // of the moving cluster, in the tree's frame
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& r = step.pose.rotation[i];
        axis[k][i] = static_cast<float>((r[0] * moving_.axis[0][k] + r[1] * moving_.axis[1][k]) +
                                        r[2] * moving_.axis[2][k]);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const LanePoint own = {fixed_.axis[0][i], fixed_.axis[1][i], fixed_.axis[2][i]};
      place_[i] = dot(own, apart);
      for (std::size_t k = 0; k < 3; ++k) turn_[i][k] = dot(own, axis[k]);
    }
  }

  [[nodiscard]] std::uint32_t fixed_count() const noexcept { return fixed_count_; }
  [[nodiscard]] std::uint32_t moving_count() const noexcept { return moving_count_; }
  [[nodiscard]] float error() const noexcept { return error_; }
  [[nodiscard]] TriangleIds ids(std::uint32_t fixed, std::uint32_t moving) const noexcept {
    return {fixed_.id[fixed], moving_.id[moving]};
  }
  [[nodiscard]] LaneTriangle fixed(std::uint32_t lane) const noexcept { return own(fixed_, lane); }
  [[nodiscard]] LaneTriangle moving(std::uint32_t lane) const noexcept {
    LaneTriangle t = own(moving_, lane);
    for (LanePoint& p : t) {
      const LanePoint from = p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = dot(turn_[i], from) + place_[i];
    }
    return t;
  }

 private:
  static std::uint32_t count_of(std::uint32_t triangles, std::uint32_t cluster) noexcept {
    return std::min(triangles - kClusterWidth * cluster, kClusterWidth);
  }
  static LaneTriangle own(const TriangleCluster& cluster, std::uint32_t lane) noexcept {
    LaneTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) t[k][i] = cluster.corner[k][i][lane];
    }
    return t;
  }

  const TriangleCluster &fixed_, &moving_;
  std::uint32_t fixed_count_, moving_count_;
  float error_;
  LanePoint turn_[3], place_;
};

/// Returns whether the boxes round two triangles are more than `distance` apart along an axis.
[[nodiscard]] inline bool boxes_apart(const LaneTriangle& a, const LaneTriangle& b,
                                      float distance) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [a_low, a_high] = std::minmax({a[0][i], a[1][i], a[2][i]});
    const auto [b_low, b_high] = std::minmax({b[0][i], b[1][i], b[2][i]});
    if (a_low > b_high + distance || b_low - distance > a_high) return true;
  }
  return false;
}

/// Returns the most by which a determinant of three differences is wrong, each of whose coordinates
/// is wrong by at most `error`; x, y and z are their sizes, and twice the error more.
[[nodiscard]] inline float determinant_error(float x, float y, float z, float error) noexcept {
  return ((x * y + (x + y) * z) * error + ((x * y) * z) * kDeterminantRounding) + kUnderflow;
}

/// The sides of one triangle's plane on which the corners of the other lie.
struct LaneSides {
  float of[3], error;

  LaneSides(const LaneTriangle& plane, const LaneTriangle& corners, float difference) noexcept {
    const LanePoint u = plane[1] - plane[0], v = plane[2] - plane[0], n = cross(u, v);
    const LanePoint s = corners[1] - corners[0], t = corners[2] - corners[0];
    const LanePoint w = corners[0] - plane[0];
    of[0] = dot(n, w);
    of[1] = of[0] + dot(n, s);
    of[2] = of[0] + dot(n, t);
    const float more = 2 * difference;
    error = determinant_error(size(u) + more, size(v) + more,
                              (size(w) + more) + std::max(size(s), size(t)), difference);
  }
  /// Returns whether all corners are certainly on one side.
  [[nodiscard]] bool one_sided() const noexcept {
    return (of[0] > error && of[1] > error && of[2] > error) ||
           (-of[0] > error && -of[1] > error && -of[2] > error);
  }
  /// Returns whether it is certain on which side each corner lies.
  [[nodiscard]] bool certain() const noexcept {
    return std::abs(of[0]) > error && std::abs(of[1]) > error && std::abs(of[2]) > error;
  }
  /// Returns the corner that is alone on its side. Precondition: certain(), not one_sided().
  [[nodiscard]] std::size_t lone() const noexcept {
    const bool a = of[0] < 0, b = of[1] < 0, c = of[2] < 0;
    return a == b ? 2 : a == c ? 1 : 0;
  }
};

enum class Decision : std::uint8_t { kApart, kMeet, kOpen };

/// Decides whether two triangles meet, where that is certain. The coordinates' differences are
/// wrong by at most `error`.
///
/// Source: O. Devillers and P. Guigue, Faster triangle-triangle intersection tests, INRIA, 2002.
[[nodiscard]] inline Decision decide(LaneTriangle a, LaneTriangle b, float error) noexcept {
  const LaneSides of_b(a, b, error), of_a(b, a, error);
  if (of_b.one_sided() || of_a.one_sided()) return Decision::kApart;
  if (!of_a.certain() || !of_b.certain()) return Decision::kOpen;
  // Each triangle's first corner alone, on the positive side of the other's plane.
  const bool turn_b = of_a.of[of_a.lone()] < 0, turn_a = of_b.of[of_b.lone()] < 0;
  std::rotate(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(of_a.lone()), a.end());
  std::rotate(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(of_b.lone()), b.end());
  if (turn_a) std::swap(a[1], a[2]);
  if (turn_b) std::swap(b[1], b[2]);
  // The segments in which the triangles meet the planes' line overlap where both are negative.
  const LanePoint w = b[0] - a[0], u = a[1] - a[0], v = a[2] - a[0];
  const LanePoint s = b[1] - b[0], t = b[2] - b[0];
  const float first = dot(cross(u, w), s), last = dot(cross(w, v), t);
  const auto sized = [&](const LanePoint& p) { return size(p) + 2 * error; };
  const float first_error = determinant_error(sized(u), sized(w), sized(s), error);
  const float last_error = determinant_error(sized(v), sized(w), sized(t), error);
  if (first > first_error || last > last_error) return Decision::kApart;
  return -first > first_error && -last > last_error ? Decision::kMeet : Decision::kOpen;
}

/// Returns the corner of a triangle that lies least far along v.
[[nodiscard]] inline const LanePoint& lowest(const LaneTriangle& t, const LanePoint& v) noexcept {
  return *std::min_element(t.begin(), t.end(), [&](const LanePoint& p, const LanePoint& q) {
    return dot(p, v) < dot(q, v);
  });
}

/// The looks at a pair of triangles for its distance.
inline constexpr int kLooks = 12;
/// A square whose rounding is that of float, whatever underflowed on the way to it.
inline constexpr float kLeastSquare = 0x1p-100F;
/// More than underflow can take from a length by taking it from the square.
inline constexpr float kLeastLength = 0x1p-72F;

/// Returns what the distance of two triangles is at most, by the square of the distance of two of
/// their points, as far as that is known.
[[nodiscard]] inline float nearest_of(float square, float error) noexcept {
  return (std::sqrt(square) * (1 + 0x1p-20F) + 4 * error) + kLeastLength;
}

/// The squares of a distance that two triangles have at least, and of one that they have at most,
/// but for the rounding of coordinates (nearest_of). Along some vector v the triangles are as far
/// apart as along none, and along none nearer than that, whatever v is, but for the rounding of
/// coordinates: twice `error` for each unit of size(v). Each look takes the vector between the
/// nearest points so far.
///
/// Source: E. G. Gilbert, An iterative procedure for computing the minimum of a quadratic form on a
/// convex set, SIAM Journal on Control 4, 1966.
struct LaneDistance {
  float least = 0, most;

  LaneDistance(const LaneTriangle& a, const LaneTriangle& b, float error) noexcept {
    const auto middle = [](const LaneTriangle& t, std::size_t i) {
      return ((t[0][i] + t[1][i]) + t[2][i]) * (1.0F / 3);
    };
    LanePoint v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = middle(b, i) - middle(a, i);
    float length = dot(v, v);
    most = length;
    for (int look = 0; look < kLooks; ++look) {
      const LanePoint back = {-v[0], -v[1], -v[2]};
      const LanePoint &p = lowest(a, back), &q = lowest(b, v);
      const float gap = (dot(q, v) + dot(p, back)) - 2 * error * size(v);
      // A gap is of the dimension of a square: so its own square may overflow.
      if (gap > 0 && length > kLeastSquare) least = std::max(least, gap * (gap / length));
      const LanePoint step = (q - p) - v;
      const float squared = dot(step, step);
      if (!(squared > 0)) break;
      const float by = std::clamp(-dot(v, step) / squared, 0.0F, 1.0F);
      for (std::size_t i = 0; i < 3; ++i) v[i] += by * step[i];
      length = dot(v, v);
      most = std::min(most, length);
    }
    least *= 1 - 0x1p-20F;
  }
};

}  // namespace ist
